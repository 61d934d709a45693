// SPDX-License-Identifier: MPL-2.0
// The event display: the table beside the picture, stepping through events, what is selected.
import { EventScene, planeColours, trackColours } from "./scene.js";
import { colour, startTheme } from "./theme.js";

const view = JSON.parse(document.getElementById("data").textContent);
if (view.format !== "scifi-event-view" || view.version !== 1) throw new Error(`not a scifi-event-view of version 1: ${view.format} ${view.version}`);

const $ = (id) => document.getElementById(id);
const fixed = (x, digits) => (x === null || x === undefined ? "–" : x.toFixed(digits).replace("-", "−"));
const counted = (n, one, many) => `${n} ${n === 1 ? one : many}`;
const sign = (charge) => (charge > 0 ? "+" : charge < 0 ? "−" : "0");
const nameOf = (tracker) => view.trackers.find((t) => t.tracker === tracker)?.name || `${tracker}`;
const viewOf = (tracker, station, plane) =>
  view.trackers.find((t) => t.tracker === tracker)?.stations.find((s) => s.station === station)?.planes[plane]?.view ?? `${plane}`;
const particles = { 13: "μ⁻", "-13": "μ⁺", 211: "π⁺", "-211": "π⁻", 11: "e⁻", "-11": "e⁺", 2212: "p" };

let at = 0;
let chosen = null;
let scene = null;
const current = () => view.events[at];

function tell(what) {
  if (what === null) return "";
  if (what.digit) {
    const d = what.digit;
    return `${nameOf(d.tracker)} station ${d.station}, plane ${viewOf(d.tracker, d.station, d.plane)}\nchannel ${d.channel}, ${fixed(d.npe, 1)} p.e.`;
  }
  if (what.point) {
    const p = what.point;
    const channels = p.channels.map(([plane, channel]) => `${viewOf(p.tracker, p.station, plane)} ${channel}`).join(", ");
    return `space point, ${nameOf(p.tracker)} station ${p.station}\nx ${fixed(p.at[0], 2)}, y ${fixed(p.at[1], 2)} mm\nchannels ${channels}; ${fixed(p.npe, 1)} p.e.`;
  }
  if (what.particle) {
    const p = what.particle;
    return `true particle ${p.particle}: ${particles[p.pdg] ?? p.pdg}\npT ${fixed(Math.hypot(p.p[0], p.p[1]), 1)}, pz ${fixed(p.p[2], 1)} MeV/c where it enters`;
  }
  const t = current().tracks[what.track];
  return `track ${t.track}, ${nameOf(t.tracker)}, charge ${sign(t.charge)}\n${momenta(t)}`;
}

const momenta = (t) => (t.model === "line" ? "straight" : `pT ${fixed(Math.hypot(t.px[0], t.py[0]), 1)}, pz ${fixed(t.pz[0], 1)} MeV/c`);

function select(index, scroll) {
  chosen = index;
  scene?.choose(index);
  for (const row of $("tracks").tBodies[0].rows) row.setAttribute("aria-selected", String(Number(row.dataset.index) === index && index !== null));
  if (scroll && index !== null) $("tracks").querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
  drawDetails();
}

const pullsWide = 380, pullsHigh = 96;

/// The pulls of a track's measurements, plane by plane.
function pullsDrawing(points, name) {
  const most = Math.max(3, ...points.map((p) => Math.abs(p.pull ?? 0)));
  const left = 30, right = pullsWide - 6, top = 8, bottom = pullsHigh - 20;
  const y = (pull) => (top + bottom) / 2 - (pull / most) * ((bottom - top) / 2);
  const step = (right - left) / points.length;
  const grid = [-most, 0, most].map((v) => `<line x1="${left}" x2="${right}" y1="${y(v)}" y2="${y(v)}" stroke="var(--rule)"/>` +
    `<text x="${left - 4}" y="${y(v) + 3}" text-anchor="end">${fixed(v, v === 0 || Number.isInteger(v) ? 0 : 1)}</text>`).join("");
  const bars = points.map((p, i) => {
    if (p.pull === null) return "";
    const value = y(p.pull);
    return `<rect x="${left + i * step + step * 0.2}" width="${step * 0.6}" y="${Math.min(value, y(0))}" height="${Math.max(1, Math.abs(value - y(0)))}" ` +
      `fill="${p.outlier ? "none" : `var(--${name})`}" stroke="var(--${name})"><title>station ${p.station}, plane ${p.plane}: pull ${fixed(p.pull, 2)}, residual ${fixed(p.residual, 3)} mm</title></rect>`;
  }).join("");
  const stations = [...new Set(points.map((p) => p.station))].map((s) => {
    const of = points.map((p, i) => (p.station === s ? i : -1)).filter((i) => i >= 0);
    return `<text x="${left + step * (of[0] + of.length / 2)}" y="${pullsHigh - 6}" text-anchor="middle">station ${s}</text>`;
  }).join("");
  return `<svg viewBox="0 0 ${pullsWide} ${pullsHigh}" role="img" aria-label="Pull of each measurement, station by station">${grid}${bars}${stations}</svg>`;
}

function drawDetails() {
  const holder = $("details");
  if (chosen === null) {
    holder.innerHTML = current().tracks.length > 0 ? "<p>Click a track, here or in the picture.</p>" : "";
    return;
  }
  const t = current().tracks[chosen];
  const row = (name, pair, digits, unit) => `<tr><td>${name}</td><td>${fixed(pair[0], digits)}</td><td>± ${fixed(pair[1], digits)}</td><td>${unit}</td></tr>`;
  const straight = t.model === "line";
  const p = Math.hypot(t.px[0], t.py[0], t.pz[0]);
  holder.innerHTML = `<h2>Track ${t.track} in ${nameOf(t.tracker)}: ${straight ? "straight line" : `helix, charge ${sign(t.charge)}`}</h2>
    <p>${t.planes} measurements in ${t.stations} stations, χ² ${fixed(t.chi2, 2)} for ${t.ndf} degrees of freedom, probability ${fixed(t.p_value, 4)}</p>
    <table><tbody>${row("<i>x</i>", t.x, 3, "mm")}${row("<i>y</i>", t.y, 3, "mm")}${straight ? "" : row("<i>p</i><sub>x</sub>", t.px, 2, "MeV/c") +
      row("<i>p</i><sub>y</sub>", t.py, 2, "MeV/c") + row("<i>p</i><sub>z</sub>", t.pz, 2, "MeV/c") + `<tr><td><i>p</i></td><td>${fixed(p, 2)}</td><td></td><td>MeV/c</td></tr>`}
    </tbody></table>${t.points.length > 0 ? `<p>Pulls: (measured − fitted without it) / σ</p>${pullsDrawing(t.points, `track-${chosen % trackColours}`)}` : "<p>No track points were given.</p>"}`;
}

function drawTable() {
  const body = $("tracks").tBodies[0];
  body.replaceChildren(...current().tracks.map((t, i) => {
    const row = document.createElement("tr");
    row.dataset.index = i;
    row.tabIndex = 0;
    row.setAttribute("aria-selected", "false");
    const straight = t.model === "line";
    const cells = [null, nameOf(t.tracker), sign(t.charge), `${t.planes}`, t.ndf > 0 ? fixed(t.chi2 / t.ndf, 2) : "–",
      straight ? "–" : fixed(Math.hypot(t.px[0], t.py[0]), 1), straight ? "–" : fixed(t.pz[0], 1)];
    for (const text of cells) row.insertCell().textContent = text ?? "";
    row.cells[0].innerHTML = `<span class="swatch" style="background:var(--track-${i % trackColours})"></span>${t.track}`;
    row.addEventListener("click", () => select(chosen === i ? null : i));
    row.addEventListener("keydown", (e) => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); select(i); } });
    return row;
  }));
  $("tracks").hidden = current().tracks.length === 0;
  $("none").hidden = current().tracks.length > 0;
}

function drawLegend() {
  const e = current();
  const views = [];
  for (const t of view.trackers) for (const s of t.stations) s.planes.forEach((p, i) => { (views[i % planeColours] ??= new Set()).add(p.view); });
  const line = (c, dash = "", wide = 2) => `<line x1="1" y1="8" x2="27" y2="8" stroke="${c}" stroke-width="${wide}" stroke-dasharray="${dash}"/>`;
  const entries = [
    ["tracks", "fitted tracks", `<line x1="1" y1="5" x2="27" y2="5" stroke="var(--track-0)" stroke-width="3"/><line x1="1" y1="11" x2="27" y2="11" stroke="var(--track-2)" stroke-width="3"/>`, e.tracks.length],
    ["space points", "space points", `<circle cx="8" cy="8" r="4.5" fill="var(--point)"/><circle cx="20" cy="8" r="4" fill="none" stroke="var(--point)" stroke-width="2"/>`, e.space_points.length],
    ...views.map((names, i) => [`channels-${i}`, `hit channels ${[...names].join("/")}`, line(`var(--plane-${i})`, "", 1.6), e.digits.filter((d) => d.plane % planeColours === i).length]),
    ["stations", "stations", `<ellipse cx="14" cy="8" rx="5" ry="7" fill="var(--station)" fill-opacity="0.15" stroke="var(--station)"/>`, null],
  ];
  if (view.events.some((one) => one.truth)) entries.push(["truth", "true particles", line("var(--truth)", "6 4"), e.truth?.length ?? 0]);
  $("legend").replaceChildren(...entries.map(([layer, words, drawing, count]) => {
    const item = document.createElement("label");
    item.innerHTML = `<input type="checkbox"><svg width="28" height="16" aria-hidden="true">${drawing}</svg><span>${words}</span>${count === null ? "" : `<small>${count}</small>`}`;
    if (layer === "space points") item.title = "filled: of three clusters or more; ring: of two";
    const box = item.firstChild;
    box.dataset.layer = layer;
    box.checked = scene?.shown.has(layer) ?? true;
    box.addEventListener("change", () => scene?.layer(layer, box.checked));
    return item;
  }));
}

function go(index) {
  at = Math.min(Math.max(index, 0), view.events.length - 1);
  const e = current();
  $("event").value = at;
  $("position").textContent = `${at + 1} of ${view.events.length}`;
  $("previous").disabled = at === 0;
  $("next").disabled = at === view.events.length - 1;
  $("summary").textContent = [counted(e.digits.length, "digit", "digits"), counted(e.space_points.length, "space point", "space points"),
    counted(e.tracks.length, "track", "tracks"), view.field === 0 ? "no field" : `${view.field} T`].join(" · ");
  scene?.drawEvent(e);
  drawTable();
  drawLegend();
  select(null);
}

function start() {
  document.title = $("title").textContent = view.title;
  $("title").title = view.title;
  $("event").replaceChildren(...view.events.map((e, i) => new Option(`${e.event}`, i)));
  startTheme($("theme"), () => scene?.recolour());
  if (view.events.length === 0) {
    $("summary").textContent = "There is no event in the file.";
    return;
  }
  const tip = $("tip");
  try {
    scene = new EventScene($("view"), view.trackers, {
      picked: (what) => select(what?.track ?? null, true),
      hovered: (what, e) => {
        tip.hidden = what === null;
        if (what === null) return;
        tip.textContent = tell(what);
        const box = $("view").getBoundingClientRect();
        tip.style.left = `${Math.min(e.clientX - box.left + 14, box.width - tip.offsetWidth - 8)}px`;
        tip.style.top = `${Math.min(e.clientY - box.top + 14, box.height - tip.offsetHeight - 8)}px`;
      },
    });
  } catch (error) {
    // Without WebGL the table still tells.
    $("failure").hidden = false;
    $("failure").textContent = `The picture cannot be drawn: ${error.message}`;
  }
  for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => scene?.look(button.dataset.view));
  $("stretch").addEventListener("change", (e) => scene?.stretch(Number(e.target.value)));
  if (view.trackers.length > 1) {
    const choice = document.createElement("select");
    choice.id = "tracker";
    choice.title = "Which tracker is drawn";
    choice.append(new Option("all trackers", ""), ...view.trackers.map((t) => new Option(t.name || `tracker ${t.tracker}`, t.tracker)));
    choice.addEventListener("change", () => scene?.showTracker(choice.value === "" ? null : Number(choice.value)));
    $("trackers").append(choice);
  }
  $("previous").addEventListener("click", () => go(at - 1));
  $("next").addEventListener("click", () => go(at + 1));
  $("event").addEventListener("change", (e) => go(Number(e.target.value)));
  addEventListener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || e.target.tagName === "SELECT" || e.target.tagName === "INPUT") return;
    const keys = {
      ArrowLeft: () => go(at - 1), ArrowRight: () => go(at + 1), Escape: () => select(null),
      o: () => scene?.look("oblique"), s: () => scene?.look("side"), t: () => scene?.look("top"), f: () => scene?.look("front"),
    };
    keys[e.key]?.();
  });
  go(0);
}

start();

// For tests and for the console.
window.scifiDisplay = {
  view,
  drawnTracks: () => scene?.trackLines.filter(({ line }) => line.visible).length ?? 0,
  selected: () => chosen,
  screenPosition: (index) => scene.screenPosition(index),
};
