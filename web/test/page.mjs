// Tests the page in Chromium as a user would operate it: node page.mjs ADDRESS CHROMIUM PICTURE CHECKPOINT
import assert from "node:assert/strict";
import fs from "node:fs";
import { chromium } from "playwright-core";

const [address, executablePath, picture, checkpoint] = process.argv.slice(2);
// WebGPU on software Vulkan, and a canvas with content.
const args = ["--headless=new", "--no-sandbox", "--enable-unsafe-webgpu", "--enable-features=Vulkan",
  "--use-vulkan=swiftshader", "--use-angle=swiftshader", "--disable-background-networking",
  "--disable-component-update", "--no-first-run"];
const browser = await chromium.launch({ executablePath, headless: false, args });
const scene = `
[scene]
name = "small"
duration = 2
[domain]
min = [0, 0, 0]
max = [1, 0.6, 0.3]
[fluid]
particle_spacing = 0.05
[[fluid.block]]
position = [0, 0, 0]
size = [0.4, 0.4, 0.3]
[solver]
sound_speed = 10
`;

async function open(path, prepare = async () => {}) {
  const page = await browser.newPage({ viewport: { width: 720, height: 420 }, acceptDownloads: true });
  const errors = [];
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(String(error)));
  await prepare(page);
  await page.goto(address + path);
  return { page, errors };
}

async function until(what, seconds, look) {
  const end = Date.now() + 1000 * seconds;
  let last;
  while (Date.now() < end) {
    last = await look();
    if (last) return last;
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
  assert.fail(`${what} did not happen within ${seconds} s`);
}

const figures = (page) => page.evaluate(() => window.splashdown?.figures());

async function runs() {
  const { page, errors } = await open("#toml=" + encodeURIComponent(scene));
  const before = await until("a first height", 60, async () => {
    const now = await figures(page).catch(() => undefined);
    return now?.mean_height ? now : undefined;
  });
  assert.equal(before.particles, 8 * 8 * 6);
  const after = await until("falling water", 60, async () => {
    const now = await figures(page);
    return now.mean_height < before.mean_height - 0.005 ? now : undefined;
  });
  assert(after.time > before.time);
  assert.equal(after.particles, before.particles);

  // The space key pauses the simulation, and a drag rotates the view.
  const clip = { x: 40, y: 80, width: 320, height: 240 };
  await page.keyboard.press("Space");
  const paused = await until("a pause", 20, async () => {
    const now = await figures(page);
    return now.playing ? undefined : now;
  });
  await page.mouse.move(360, 300);
  await new Promise((resolve) => setTimeout(resolve, 1500));
  const still = await page.screenshot({ clip });
  await new Promise((resolve) => setTimeout(resolve, 1000));
  assert(still.equals(await page.screenshot({ clip })), "the picture changes while paused");
  await page.mouse.move(150, 200);
  await page.mouse.down();
  await page.mouse.move(230, 220, { steps: 4 });
  await page.mouse.up();
  await page.mouse.move(360, 300);
  await new Promise((resolve) => setTimeout(resolve, 1500));
  assert(!still.equals(await page.screenshot({ clip })), "a drag did not rotate the view");
  assert.equal((await figures(page)).time, paused.time);

  // The downloaded mesh is a closed PLY.
  const download = page.waitForEvent("download", { timeout: 60_000 });
  await page.keyboard.press("m");
  const file = await (await download).path();
  const ply = fs.readFileSync(file);
  closed(ply);

  // A checkpoint is downloaded, stored for the command line, and dropped onto the page again.
  const saved = page.waitForEvent("download", { timeout: 60_000 });
  await page.keyboard.press("k");
  await (await saved).saveAs(checkpoint);
  await page.keyboard.press(".");
  await until("a step", 30, async () => (await figures(page)).time > paused.time);
  const bytes = fs.readFileSync(checkpoint).toString("base64");
  await page.evaluate((bytes) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(atob(bytes), (c) => c.charCodeAt(0))], "small.splashdown"));
    document.getElementById("canvas").dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true }));
  }, bytes);
  await until("the time of the checkpoint", 30, async () => (await figures(page)).time === paused.time);

  // The surface is drawn, and a screenshot is stored.
  await page.keyboard.press("3");
  await until("a surface", 60, async () => (await figures(page)).triangles > 100);
  await new Promise((resolve) => setTimeout(resolve, 1500));
  await page.screenshot({ path: picture });
  assert.deepEqual(errors, []);
  await page.close();
}

// Independent check: every edge exists twice, in opposite directions.
function closed(ply) {
  const end = ply.indexOf("end_header\n") + "end_header\n".length;
  const header = ply.subarray(0, end).toString();
  const count = (name) => Number(header.match(new RegExp(`element ${name} (\\d+)`))[1]);
  const properties = header.split("element face")[0].match(/property float/g).length;
  const [vertices, triangles] = [count("vertex"), count("face")];
  assert(vertices > 50 && triangles > 100, `${vertices} vertices, ${triangles} triangles`);
  const edges = new Map();
  let at = end + vertices * properties * 4;
  for (let t = 0; t < triangles; t++) {
    assert.equal(ply[at], 3);
    const v = [0, 1, 2].map((k) => ply.readUInt32LE(at + 1 + 4 * k));
    for (let k = 0; k < 3; k++) {
      const edge = `${v[k]},${v[(k + 1) % 3]}`;
      assert(!edges.has(edge), `edge ${edge} twice`);
      edges.set(edge, true);
    }
    at += 13;
  }
  assert.equal(at, ply.length);
  for (const edge of edges.keys()) {
    assert(edges.has(edge.split(",").reverse().join(",")), `edge ${edge} has no opposite`);
  }
}

// A body and a second piece of fluid: the start loads a mesh and measures the initial packing.
async function runsWithBodies() {
  const pieces = `
[[fluid.block]]
position = [0.42, 0, 0.01]
size = [0.2, 0.2, 0.2]
[[body]]
name = "cube"
mesh = "cube"
scale = 0.1
position = [0.7, 0.1, 0.15]
`;
  const text = scene.replace("[solver]", `${pieces}[solver]`);
  const { page, errors } = await open("#toml=" + encodeURIComponent(text));
  await until("a step with a body", 120, async () => {
    assert.deepEqual(errors, []);
    const now = await figures(page).catch(() => undefined);
    return now?.time > 0 && now.particles > 8 * 8 * 6;
  });
  await page.close();
}

async function compilesEveryPass() {
  const { page } = await open("#toml=" + encodeURIComponent(scene));
  await until("the start", 60, () => page.evaluate(() => !!window.splashdown));
  const valid = await page.evaluate(() => window.splashdown.tryPasses(false));
  assert(valid.passes > 60, `only ${valid.passes} passes`);
  assert.deepEqual(valid.refused, []);
  // Negative control: a pass that no device accepts.
  const broken = await page.evaluate(() => window.splashdown.tryPasses(true));
  assert.equal(broken.passes, valid.passes + 1);
  assert.equal(broken.refused.length, 1);
  assert.match(broken.refused[0], /broken/);
  await page.close();
  return valid.passes;
}

// The browser destroys the device: the program restarts with the state from a few seconds earlier.
async function recoversFromALostDevice() {
  const catchDevice = (page) => page.addInitScript(() => {
    const request = GPUAdapter.prototype.requestDevice;
    GPUAdapter.prototype.requestDevice = async function (...given) {
      return (window.lastDevice = await request.apply(this, given));
    };
  });
  const { page } = await open("#toml=" + encodeURIComponent(scene), catchDevice);
  let begun;
  const before = await until("a saved state", 90, async () => {
    const now = await figures(page).catch(() => undefined);
    if (now) begun ??= Date.now();
    return now?.time > 0.1 && Date.now() - begun > 15_000 ? now : undefined;
  });
  await page.evaluate(() => window.lastDevice.destroy());
  await until("the loss", 30, () => page.evaluate(() => window.splashdown.restarts() === 1));
  const after = await until("a restart", 60, async () => {
    const now = await figures(page).catch(() => undefined);
    return now && !now.lost && now.time > 0 ? now : undefined;
  });
  assert(after.time > 0.3 * before.time, `from ${before.time} s back to ${after.time} s`);
  assert.equal(after.particles, before.particles);
  await until("moving water", 60, async () => (await figures(page)).time > after.time);
  await page.close();
}

async function reportsMissingFeatures() {
  const hide = (page) => page.addInitScript(() => Object.defineProperty(navigator, "gpu", { value: undefined }));
  const { page } = await open("", hide);
  await until("a message", 20, () => page.evaluate(() => document.body.innerText.includes("has no WebGPU")));
  await page.close();
  const wrong = await open("?scene=no-such-scene");
  await until("a message", 60, () => wrong.page.evaluate(() => document.body.innerText.includes("there is no scene")));
  await wrong.page.close();
}

// Each failure of a start has a message that says what to do.
async function explainsFailedStarts() {
  const says = async (path, text, prepare) => {
    const { page } = await open(path, prepare);
    await until(`the message "${text}"`, 60, () => page.evaluate((text) => document.body.innerText.includes(text), text));
    assert.equal(await page.evaluate(() => !!window.splashdown), false);
    return page;
  };
  const script = "**/splashdown_web.js", program = "**/splashdown_web_bg.wasm";
  const answer = (pattern, given) => (page) => page.route(pattern, (route) => route.fulfill(given));
  await (await says("", "splashdown_web.js did not arrive", (page) => page.route(script, (route) => route.abort()))).close();
  await (await says("", "the server answered 404", answer(program, { status: 404, body: "" }))).close();
  await (await says("", "could not be loaded", answer(program, { contentType: "application/wasm", body: "no program" }))).close();
  await (await says("?stalled=500", "the download stopped after 0.0 of", (page) => page.route(program, () => {}))).close();

  // A link whose scene does not fit the device names a spacing that fits.
  const large = scene.replace("particle_spacing = 0.05", "particle_spacing = 0.001");
  const refused = await says("#toml=" + encodeURIComponent(large), "does not fit this device");
  assert.match(await refused.evaluate(() => document.body.innerText), /Use a fluid\.particle_spacing of 0\.\d+ m or more/);
  await refused.close();
}

// The script and the graphics device may never arrive. The page explains this, offers another try and the film, and
// starts if they arrive late.
async function explainsWhatNeverArrives() {
  const script = "**/splashdown_web.js";
  const ask = (milliseconds) => (page) => page.addInitScript((milliseconds) => {
    const request = GPU.prototype.requestAdapter;
    let asked = 0;
    GPU.prototype.requestAdapter = async function (...given) {
      if (asked++ === 0) await new Promise((resolve) => milliseconds && setTimeout(resolve, milliseconds));
      return request.apply(this, given);
    };
  }, milliseconds);
  // Only the first request for the script is not answered.
  const stall = (page) => {
    let asked = 0;
    return page.route(script, (route) => { if (asked++ > 0) route.continue(); });
  };
  const text = (page) => page.evaluate(() => document.body.innerText);
  const says = async (words, prepare) => {
    const { page } = await open("?stalled=500#toml=" + encodeURIComponent(scene), prepare);
    await until(`the message "${words}"`, 30, async () => (await text(page)).includes(words));
    return page;
  };
  for (const [words, prepare] of [
    ["splashdown_web.js has not arrived", stall],
    ["does not answer the request for a graphics device", ask(0)],
  ]) {
    const page = await says(words, prepare);
    await until("a film", 20, () => page.evaluate(() => document.querySelector("#note img")?.naturalWidth > 100));
    assert.equal(await page.evaluate(() => !!window.splashdown), false);
    // The button loads the page again, on which everything arrives.
    const loaded = page.waitForEvent("load", { timeout: 30_000 });
    const [x, y] = await page.evaluate(() => {
      const button = document.querySelector("#note button").getBoundingClientRect();
      return [button.x + button.width / 2, button.y + button.height / 2];
    });
    await page.mouse.click(x, y);
    await loaded;
    await page.close();
  }
  // Control: what arrives late starts the program, and the message disappears. The whole program may need longer than half
  // a second, so its download is not limited here.
  const late = await open("?stalled=8000#toml=" + encodeURIComponent(scene), ask(9_000));
  await until("the message", 30, async () => (await text(late.page)).includes("does not answer the request"));
  await until("the start", 90, () => late.page.evaluate(() => !!window.splashdown));
  assert.equal(await late.page.evaluate(() => document.getElementById("note").hidden), true);
  await late.page.close();
}

// Without WebGPU the page shows a film, and fits a phone.
async function showsAFilmOnAPhone() {
  const hide = (page) => page.addInitScript(() => Object.defineProperty(navigator, "gpu", { value: undefined }));
  const { page } = await open("", async (page) => {
    await page.setViewportSize({ width: 390, height: 844 });
    await hide(page);
  });
  const width = await until("a film", 20, () => page.evaluate(() => document.querySelector("#note img")?.naturalWidth));
  assert(width > 100, `the film has a width of ${width}`);
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390);
  await page.screenshot({ path: picture.replace(".png", "-phone.png") });
  await page.close();
}

try {
  const begun = Date.now();
  await runs();
  console.log("ok: runs, can be rotated and paused, exports a closed mesh");
  await runsWithBodies();
  console.log("ok: runs with a body and two pieces of fluid");
  console.log(`ok: ${await compilesEveryPass()} passes compile`);
  await recoversFromALostDevice();
  console.log("ok: recovers from a lost device");
  await explainsFailedStarts();
  console.log("ok: explains failed starts and refuses scenes that do not fit");
  await explainsWhatNeverArrives();
  console.log("ok: explains a script and a graphics device that never arrive");
  await showsAFilmOnAPhone();
  console.log("ok: shows a film without WebGPU");
  await reportsMissingFeatures();
  console.log(`ok: reports missing features (${((Date.now() - begun) / 1000).toFixed(0)} s in total)`);
} finally {
  await browser.close();
}
