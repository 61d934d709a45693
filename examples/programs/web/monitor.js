// SPDX-License-Identifier: MPL-2.0
// Histograms of a running reconstruction, drawn with JSROOT. A newer version of this file, from the same place, is loaded out of sight again and again, and
// its data are taken over: that works from a file system too, where a page may not read files.
import { addColor } from "jsroot-modules/base/colors.mjs";
import { createHistogram, gStyle, settings } from "jsroot-modules/core.mjs";
import { TH1Painter } from "jsroot-modules/hist2d/TH1Painter.mjs";
import { TH2Painter } from "jsroot-modules/hist2d/TH2Painter.mjs";

import { colour, startTheme } from "./theme.js";

const $ = (id) => document.getElementById(id);
const read = (text) => {
  const data = JSON.parse(text);
  if (data.format !== "scifi-monitor" || data.version !== 1) throw new Error(`not a scifi-monitor of version 1: ${data.format} ${data.version}`);
  return data;
};
let data = read($("data").textContent);
let tab = location.hash === "#planes" ? "planes" : "overview";
let painters = new Map();  // name -> painters of its series
let drawing = Promise.resolve();
const nameOf = (tracker) => data.trackers.find((t) => t.tracker === tracker)?.name || `tracker ${tracker}`;
// JSROOT knows colours by their number in a table of its own.
const rootColour = (name) => addColor(colour(name));
const seriesColour = (i) => rootColour(`plane-${i % 4}`);
const number = (n) => n.toLocaleString("en").replaceAll(",", "\u202f");

settings.ContextMenu = settings.ToolBar = settings.ShowTitle = false;
settings.ZoomWheel = false;
Object.assign(gStyle, { fOptStat: 0, fPadLeftMargin: 0.17, fPadRightMargin: 0.04, fPadTopMargin: 0.09, fPadBottomMargin: 0.18, fHistTopMargin: 0.08 });

const sum = (values) => values.reduce((a, b) => a + b, 0);

function axis(a, title, size) {
  const ink = rootColour("ink");
  Object.assign(a, { fTitle: title, fLabelSize: size, fTitleSize: size, fTitleOffset: 1.1, fLabelFont: 42, fTitleFont: 42, fTickLength: 0.02,
    fAxisColor: rootColour("faint"), fLabelColor: ink, fTitleColor: ink });
}

function histogram1(name, x, y, counts, line, labels = 0.045) {
  const h = createHistogram("TH1D", x.bins);
  h.fName = name;
  h.fXaxis.fXmin = x.low;
  h.fXaxis.fXmax = x.high;
  counts.forEach((n, i) => h.setBinContent(i + 1, n));
  h.fEntries = sum(counts);
  axis(h.fXaxis, x.label, labels);
  axis(h.fYaxis, y, labels);
  h.fYaxis.fTitleOffset = 1.75;
  Object.assign(h, { fTitle: "", fLineColor: line, fLineWidth: 2, fFillStyle: 0, fMinimum: 0 });
  return h;
}

function hitMap(tracker) {
  const most = Math.max(1, ...tracker.planes.map((p) => p.channels));
  const h = createHistogram("TH2D", most, tracker.planes.length);
  h.fName = `map-${tracker.tracker}`;
  h.fTitle = "";
  Object.assign(h.fXaxis, { fXmin: -0.5, fXmax: most - 0.5 });
  Object.assign(h.fYaxis, { fXmin: 0, fXmax: tracker.planes.length });
  axis(h.fXaxis, "channel", 0.045);
  axis(h.fYaxis, "", 0.045);
  h.fYaxis.fTickLength = 0;
  h.fYaxis.fLabels = { _typename: "THashList", name: "THashList", opt: [],
    arr: tracker.planes.map((p, i) => ({ _typename: "TObjString", fUniqueID: i + 1, fBits: 0, fString: `${p.station} ${p.view}` })) };
  tracker.planes.forEach((p, i) => p.hits.forEach((n, channel) => h.setBinContent(h.getBin(channel + 1, i + 1), n)));
  h.fEntries = sum(tracker.planes.map((p) => sum(p.hits)));
  return h;
}

/// What is drawn under a tab: name, title, remark, histograms in one frame, options.
function wanted() {
  if (tab === "planes") {
    return data.trackers.flatMap((t, i) => t.planes.map((p) => ({
      name: `plane ${t.tracker} ${p.station} ${p.plane}`, heading: nameOf(t.tracker), title: `station ${p.station}, view ${p.view}`, remark: `${number(sum(p.hits))} hits`,
      make: () => [histogram1(`plane-${t.tracker}-${p.station}-${p.plane}`, { label: "channel", bins: p.channels, low: -0.5, high: p.channels - 0.5 }, "", p.hits, seriesColour(i), 0.07)],
      painter: TH1Painter, option: "hist",
    })));
  }
  const maps = data.trackers.map((t) => ({
    name: `map ${t.tracker}`, title: `Hit map, ${nameOf(t.tracker)}`, remark: "station and view against channel", wide: true, make: () => [hitMap(t)], painter: TH2Painter, option: "colz",
  }));
  const plots = data.plots.map((p) => {
    const outside = sum(p.series.map((s) => s.underflow + s.overflow));
    const total = sum(p.series.map((s) => sum(s.counts))) + outside;
    return {
      name: p.name, title: p.title, remark: `${number(total)}${outside > 0 ? `, ${number(outside)} outside` : ""}`,
      make: () => {
        const most = Math.max(1, ...p.series.flatMap((s) => s.counts)) * 1.1;
        return p.series.map((s, i) => Object.assign(histogram1(`${p.name}-${s.tracker}`, p.x, p.y, s.counts, seriesColour(i)), { fMaximum: most }));
      },
      painter: TH1Painter, option: "hist",
    };
  });
  return [...maps, ...plots];
}

async function draw() {
  const ground = rootColour("ground");
  Object.assign(gStyle, { fCanvasColor: ground, fPadColor: ground, fFrameFillColor: ground, fFrameLineColor: rootColour("faint") });
  const holder = $("plots");
  holder.className = tab;
  const plots = wanted();
  const complete = painters.size > 0 && plots.length === painters.size && plots.every((p) => painters.has(p.name));
  if (!complete) {
    holder.replaceChildren();
    painters = new Map();
  }
  let heading = null;
  for (const p of plots) {
    if (complete) {
      const { drawn, remark } = painters.get(p.name);
      remark.textContent = p.remark;
      const made = p.make();
      drawn.forEach((painter, i) => painter.updateObject(made[i]));
      await drawn[0]?.redrawPad?.();
      continue;
    }
    if (p.heading && p.heading !== heading) {
      heading = p.heading;
      const h = document.createElement("h2");
      h.textContent = heading;
      holder.append(h);
    }
    const figure = document.createElement("figure");
    figure.className = p.wide ? "wide" : "";
    figure.innerHTML = `<figcaption><span></span><small></small></figcaption><div class="plot"></div>`;
    const [title, remark] = figure.firstChild.children;
    title.textContent = p.title;
    remark.textContent = p.remark;
    holder.append(figure);
    const drawn = [];
    for (const [i, h] of p.make().entries()) {
      drawn.push(await p.painter.draw(figure.lastChild, h, i === 0 ? p.option : `${p.option} same`));
    }
    painters.set(p.name, { drawn, remark });
  }
}

/// One drawing after the other; `anew`: with nothing kept of the last.
function redraw(anew = false) {
  drawing = drawing.then(() => {
    if (anew) painters = new Map();
    return draw();
  }).catch((error) => console.error(error));
  return drawing;
}

function showStatus() {
  const s = data.status;
  const age = Date.now() / 1000 - s.written_at;
  const silent = s.state === "running" && age > 5 * s.every_s + 5;
  const state = silent ? "silent" : s.state;
  $("state").textContent = silent ? "no longer written" : s.state;
  $("state").dataset.state = state;
  $("status").textContent = `${s.input}: ${number(s.events)} events in ${s.elapsed_s.toFixed(1)} s` +
    (s.elapsed_s > 0 && s.events > 0 ? ` (${number(Math.round(s.events / s.elapsed_s))} a second)` : "") + `, as of ${new Date(s.written_at * 1000).toLocaleTimeString("en-GB")}`;
  document.title = `${s.state}: ${s.input}`;
}

function choose(next) {
  tab = next;
  history.replaceState(null, "", tab === "planes" ? "#planes" : "#overview");
  for (const button of document.querySelectorAll("[data-tab]")) button.setAttribute("aria-selected", String(button.dataset.tab === tab));
  return redraw(true);
}

/// Loads the file again in a frame that nobody sees; it sends its data and is taken away.
function look() {
  showStatus();
  if (data.status.state !== "running") return;
  const frame = document.createElement("iframe");
  frame.hidden = true;
  frame.src = `${location.href.split(/[?#]/)[0]}?${Date.now()}#data`;
  document.body.append(frame);
  setTimeout(() => { frame.remove(); look(); }, Math.max(500, data.status.every_s * 1000));
}

addEventListener("message", (e) => {
  if (typeof e.data?.scifiMonitor !== "string") return;
  const next = read(e.data.scifiMonitor);
  if (next.status.page <= data.status.page && next.status.input === data.status.input && next.status.written_at <= data.status.written_at) return;
  data = next;
  showStatus();
  redraw();
});
addEventListener("resize", () => { for (const { drawn } of painters.values()) drawn[0]?.getPadPainter?.()?.checkResize?.(); });

if (!(location.hash === "#data" && parent !== window)) {
  for (const button of document.querySelectorAll("[data-tab]")) button.addEventListener("click", () => choose(button.dataset.tab));
  $("key").innerHTML = data.trackers.map((t, i) => `<span><i style="border-color:var(--plane-${i % 4})"></i>${t.name || `tracker ${t.tracker}`}</span>`).join("");
  let started = false;
  startTheme($("theme"), () => { if (started) choose(tab); });
  started = true;
  choose(tab);
  look();
}

// For tests and for the console.
window.scifiMonitor = { data: () => data, drawn: () => painters.size, settled: () => drawing };
