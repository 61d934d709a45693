// SPDX-License-Identifier: MPL-2.0
// Opens the pages in headless Chromium and tells, as JSON on standard output, what is seen there. Driven by pages_test.py:
//   pages.mjs <folder of npm packages> <chromium> <what> <page> <folder for screenshots> [newer page]
import { copyFileSync, renameSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [packages, executablePath, what, file, shots, newer] = process.argv.slice(2);
const { chromium } = createRequire(join(packages, "/"))("playwright-core");

const browser = await chromium.launch({ executablePath, args: [
  "--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
  "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",  // WebGL without a graphics card
] });
const seen = { errors: [], requests: [] };
const page = await browser.newPage({ viewport: { width: 1300, height: 760 }, colorScheme: "light" });
page.on("console", (m) => { if (m.type() === "error") seen.errors.push(m.text()); });
page.on("pageerror", (e) => seen.errors.push(e.message));
page.on("request", (r) => { if (!/^(file|data|blob|about):/.test(r.url())) seen.requests.push(r.url()); });
await page.goto(pathToFileURL(file).href);

/// How many pixels of a piece of the page are of another colour than its corner, and how many colours there are.
async function pixels(selector, shot) {
  const image = await page.locator(selector).screenshot({ path: join(shots, shot) });
  return page.evaluate(async (bytes) => {
    const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))], { type: "image/png" }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const g = canvas.getContext("2d");
    g.drawImage(bitmap, 0, 0);
    const { data } = g.getImageData(0, 0, bitmap.width, bitmap.height);
    const colours = new Map();
    for (let i = 0; i < data.length; i += 4) {
      const key = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
      colours.set(key, (colours.get(key) ?? 0) + 1);
    }
    const most = Math.max(...colours.values());
    return { colours: colours.size, drawn: 1 - most / (data.length / 4) };
  }, image.toString("base64"));
}

const rows = () => page.locator("#tracks tbody tr").count();
const selectedRow = () => page.evaluate(() => [...document.querySelectorAll('#tracks tr[aria-selected="true"]')].map((r) => Number(r.dataset.index)));

async function display() {
  seen.events = [];
  const count = await page.locator("#event option").count();
  for (let i = 0; i < count; ++i) {
    seen.events.push({ event: await page.locator("#event option:checked").textContent(), rows: await rows(), drawn: await page.evaluate(() => scifiDisplay.drawnTracks()) });
    if (i + 1 < count) await page.click("#next");
  }
  seen.nextAtEnd = await page.locator("#next").isDisabled();
  await page.keyboard.press("ArrowLeft");
  seen.afterArrow = await page.locator("#event option:checked").textContent();
  await page.selectOption("#event", "0");
  seen.pixels = await pixels("#view", "display.png");

  // In the table, then in the picture: both show it in both places.
  await page.click("#tracks tbody tr:last-child");
  seen.clickedRow = { row: await selectedRow(), scene: await page.evaluate(() => scifiDisplay.selected()), details: await page.locator("#details").innerText() };
  await page.keyboard.press("Escape");
  seen.afterEscape = await selectedRow();
  const at = await page.evaluate(() => scifiDisplay.screenPosition(0));
  await page.mouse.move(at.x, at.y);
  seen.tip = await page.locator("#tip").innerText();
  await page.mouse.click(at.x, at.y);
  seen.clickedPicture = { row: await selectedRow(), scene: await page.evaluate(() => scifiDisplay.selected()) };
  await page.screenshot({ path: join(shots, "display_selected.png") });
  await page.mouse.move(6, 400);

  // Drag: the picture turns, the selection stays.
  const before = await page.evaluate(() => scifiDisplay.screenPosition(0));
  await page.mouse.move(500, 600);
  await page.mouse.down();
  await page.mouse.move(620, 560, { steps: 4 });
  await page.mouse.up();
  const after = await page.evaluate(() => scifiDisplay.screenPosition(0));
  seen.turned = Math.hypot(after.x - before.x, after.y - before.y);
  seen.afterTurn = await selectedRow();

  await page.click('#legend input[data-layer="tracks"]');
  seen.drawnHidden = await page.evaluate(() => scifiDisplay.drawnTracks());
  await page.click('#legend input[data-layer="tracks"]');
  for (const view of ["side", "top", "front"]) {
    await page.click(`[data-view="${view}"]`);
    seen[view] = await pixels("#view", `display_${view}.png`);
  }
  await page.click("#theme");
  seen.dark = await page.evaluate(() => document.documentElement.dataset.theme);
  seen.darkPixels = await pixels("#view", "display_dark.png");
}

async function monitor() {
  const settled = () => page.evaluate(() => scifiMonitor.settled());
  const state = () => page.evaluate(() => scifiMonitor.data().status);
  await settled();
  seen.first = { ...(await state()), plots: await page.evaluate(() => scifiMonitor.drawn()), figures: await page.locator("figure svg").count() };
  // A newer version takes the place of the file.
  copyFileSync(newer, `${file}.partial`);
  renameSync(`${file}.partial`, file);
  await page.waitForFunction(() => scifiMonitor.data().status.state === "done", null, { timeout: 20000 });
  await settled();
  seen.second = { ...(await state()), shown: await page.locator("#state").textContent(), status: await page.locator("#status").textContent() };
  seen.pixels = await pixels("#plots", "monitor.png");
  seen.lines = await page.evaluate(() => [...document.querySelectorAll("figure svg path")].filter((p) => (p.getAttribute("d") ?? "").length > 200).length);
  await page.click("#tab-planes");
  await settled();
  seen.planes = { plots: await page.evaluate(() => scifiMonitor.drawn()), ...(await pixels("#plots", "monitor_planes.png")) };
  await page.click("#theme");
  await settled();
  seen.dark = await pixels("#plots", "monitor_dark.png");
}

await { display, monitor }[what]();
await browser.close();
console.log(JSON.stringify(seen));
