// The page of `palpate view` in a headless browser: what it shows, which page steers, and the forces on the way.
//   node tests/page/page_test.mjs PALPATE PAGE_FOLDER OUT_FOLDER [NAME...]
// PAGE_FOLDER holds the node_modules that tools/page/build.sh has installed; OUT_FOLDER gets the pictures. NAME: only these tests.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

const [palpate, pageFolder, out, ...names] = process.argv.slice(2);
const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const require = createRequire(path.join(path.resolve(pageFolder), "package.json"));
const { chromium } = require("playwright-core");

const patience = 600_000; // [ms] far longer than anything takes on a busy machine
const scene = (name) => path.join(root, "data/scenes", `${name}.yaml`);

/** `palpate view` as it runs. */
class Served {
  /** The running ones; a test that fails does not stop its own. */
  static running = new Set();

  constructor(...options) {
    Served.running.add(this);
    this.process = spawn(palpate, ["view", ...options, "--no-open", "--json"], { stdio: ["ignore", "pipe", "pipe"] });
    this.out = "";
    this.err = "";
    this.process.stdout.on("data", (bytes) => (this.out += bytes));
    this.url = new Promise((resolve, reject) => {
      this.process.stderr.on("data", (bytes) => {
        this.err += bytes;
        const found = /^http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\/$/m.exec(this.err);
        if (found) resolve(found[0]);
      });
      this.process.on("exit", (code) => reject(new Error(`palpate view ended with ${code}: ${this.err}${this.out}`)));
    });
    this.url.catch(() => {});
    this.ended = new Promise((resolve) => this.process.on("exit", resolve));
    void this.ended.then(() => Served.running.delete(this));
  }
  async stop() {
    this.process.kill("SIGINT");
    return await this.ended;
  }
}

let browser;
const asked = []; // requested addresses that are not the server's
const broken = []; // errors in pages

/** Somebody who was here before, and has closed the tour; unless `context` is somebody else's. */
async function open(served, context = null) {
  const url = await served.url;
  if (context === null) {
    context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
    await context.addCookies([{ name: "palpate_tour", value: "seen", url: "http://127.0.0.1/" }]);
  }
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  page.on("request", (request) => {
    if (!request.url().startsWith(url) && !request.url().startsWith("data:")) asked.push(request.url());
  });
  page.on("pageerror", (error) => broken.push(String(error)));
  await page.goto(url);
  await page.waitForFunction(
    () => window.palpatePage?.words && window.palpatePage.last?.tick &&
      window.palpatePage.shown === window.palpatePage.words.regions.length && window.palpatePage.last.ports,
  );
  await page.waitForFunction(() => window.palpatePage.marks.isComplete);
  return page;
}

/** Waits for a few more frames, so that the latest data of the server are shown. */
async function settle(page, frames = 3) {
  const from = await page.evaluate(() => window.palpatePage.space.frames);
  await page.waitForFunction(([first, more]) => window.palpatePage.space.frames >= first + more, [from, frames]);
}

/** The share of the scene's picture that is not background, and its number of colors. */
function look(page) {
  return page.evaluate(() => {
    const space = document.getElementById("space");
    const copy = document.createElement("canvas");
    copy.width = space.width;
    copy.height = space.height;
    const pen = copy.getContext("2d");
    pen.drawImage(space, 0, 0);
    const { data } = pen.getImageData(0, 0, copy.width, copy.height);
    const colors = new Set();
    let drawn = 0;
    const ground = data[0] | (data[1] << 8) | (data[2] << 16);
    for (let i = 0; i < data.length; i += 4) {
      const color = data[i] | (data[i + 1] << 8) | (data[i + 2] << 16);
      colors.add(color);
      if (color !== ground) ++drawn;
    }
    return { share: drawn / (data.length / 4), colors: colors.size };
  });
}

async function picture(page, name) {
  await page.waitForFunction(() => window.palpatePage.space.detail.isWhole);
  await settle(page);
  await page.screenshot({ path: path.join(out, `${name}.png`) });
  await checkLayout(page);
  const seen = await look(page);
  assert.ok(seen.share > 0.05, `${name} is blank: ${JSON.stringify(seen)}`);
  assert.ok(seen.colors > 100, `${name} has no shades: ${JSON.stringify(seen)}`);
}

/** Nothing is cut off, and no two parts of the page lie on one another. */
async function checkLayout(page) {
  const wrong = await page.evaluate(() => {
    const found = [];
    const parts = ["left", "right", "tour", "scrub", "notice"].map((id) => document.getElementById(id));
    const boxes = parts.filter((part) => part !== null && !part.hidden).map((part) => [part.id, part.getBoundingClientRect()]);
    for (const [id, box] of boxes) {
      if (box.left < 0 || box.top < 0 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5) found.push(`${id} is cut off`);
      for (const [other, that] of boxes) {
        if (id < other && box.left < that.right && that.left < box.right && box.top < that.bottom && that.top < box.bottom) {
          found.push(`${id} and ${other} overlap`);
        }
      }
    }
    for (const side of ["left", "right"]) {
      const panel = document.getElementById(side);
      // Downward it can be rolled.
      if (panel.scrollWidth > panel.clientWidth) found.push(`${side} is too wide`);
    }
    return found;
  });
  assert.deepEqual(wrong, []);
}

const tick = (page) => page.evaluate(() => window.palpatePage.last.tick);

/** The number of the state in Table I for a probe at this place, by the sphere A and the half-space B alone. */
function stateOf([x, y, z]) {
  const a = Math.hypot(x, y, z) < 0.04;
  const b = z < 0.015;
  return a ? (b ? 1 : 2) : b ? 3 : 4;
}

const tests = {
  async container() {
    const record = path.join(out, "container.npy");
    for (const end of ["", ".json", ".states"]) rmSync(record + end, { force: true });
    const served = new Served(scene("container"), "--record", record);
    const page = await open(served);
    await page.waitForFunction(() => window.palpatePage.last.steers);
    assert.equal(await page.evaluate(() => window.palpatePage.marks.ports.length), 1);
    assert.ok(await page.locator("#slices").isHidden());
    await picture(page, "container-start");

    // 100 moves: down the axis through the mouth, onto the bottom from within, and out again.
    const states = [];
    const regions = [];
    const note = (now) => {
      const state = stateOf(now.hip);
      const strength = Math.hypot(...now.force);
      if (states.at(-1) !== state) states.push(state);
      if (regions.at(-1) !== now.region) regions.push(now.region);
      // The forces by Table I: none in the states 2 and 4, ...
      if (state === 4) assert.ok(strength < 1e-9 && now.region === 0, JSON.stringify(now));
      if (state === 2 && now.region === 0) assert.ok(strength < 1e-9, JSON.stringify(now));
      if (state === 1) assert.equal(now.region, 1);
      // ... and in state 3, after ENTER_PORT, that of the wall from within: inward, which is upward here. A hand on its way
      // back up feels the drag of the syrup as well, which is downward.
      if (state === 3) assert.ok(now.region === 1 && now.contact, JSON.stringify(now));
      if (state === 3 && now.told[2] < now.hip[2]) assert.ok(now.force[2] > 0, JSON.stringify(now));
    };
    // The hand begins at the viewpoint of the scene, which may be in any state.
    await page.evaluate(() => {
      window.palpatePage.told = [0, 0, 0.06];
      window.palpatePage.changed();
    });
    await page.waitForFunction(() => window.palpatePage.last.tick.hip[2] > 0.055);
    const moves = 100;
    for (let i = 0; i < moves; ++i) {
      const share = i < moves / 2 ? i / (moves / 2 - 1) : (moves - 1 - i) / (moves / 2 - 1);
      const z = 0.06 - 0.115 * share;
      await page.evaluate((height) => {
        window.palpatePage.told = [0, 0, height];
        window.palpatePage.changed();
      }, z);
      const n = (await tick(page)).n;
      await page.waitForFunction((before) => window.palpatePage.last.tick.n > before + 30, n, { polling: 5 });
      note(await tick(page));
      if (i === moves / 2) {
        // The force holds the hand back: it is not where the page leads it.
        const now = await tick(page);
        assert.ok(now.hip[2] > now.told[2] + 1e-3, JSON.stringify(now));
        assert.ok(now.wall.startsWith("glass"), now.wall);
        await picture(page, "container-bottom");
      }
    }
    await page.waitForFunction(() => window.palpatePage.last.tick.hip[2] > 0.055);
    note(await tick(page));
    assert.deepEqual(states, [4, 2, 1, 3, 1, 2, 4]);
    assert.deepEqual(regions, [0, 1, 0]);
    const log = await page.locator("#log li").allTextContents();
    assert.match(log[1], /outside to liquid through mouth/);
    assert.match(log[0], /liquid to outside through mouth/);

    // The page reports the end of the server, and the record replays bit for bit.
    assert.equal(await served.stop(), 130);
    await page.locator("#notice").waitFor({ state: "visible" });
    assert.match(await page.locator("#notice").textContent(), /has ended/);
    await picture(page, "container-ended");
    const replayed = spawnSync(palpate, ["replay", record, "--json"], { encoding: "utf8" });
    assert.equal(replayed.status, 0, replayed.stdout + replayed.stderr);
    assert.ok(JSON.parse(replayed.stdout).compared > 1000);
    await page.context().close();
  },

  async keyboard() {
    const served = new Served(scene("container"));
    const page = await open(served);
    await page.waitForFunction(() => window.palpatePage.last.steers);
    const told = () => page.evaluate(() => window.palpatePage.told);
    const hold = async (key, isDone, argument) => {
      await page.keyboard.down(key);
      await page.waitForFunction(isDone, argument);
      await page.keyboard.up(key);
    };
    const before = await told();
    await hold("ArrowDown", (z) => window.palpatePage.told[2] < z - 0.02, before[2]);
    await page.waitForFunction((z) => window.palpatePage.last.tick.hip[2] < z - 0.015, before[2]);
    await hold("PageDown", (y) => window.palpatePage.told[1] > y + 0.005, before[1]);
    await page.keyboard.press("Home");
    assert.deepEqual(await told(), await page.evaluate(() => window.palpatePage.start));
    // Each control can be reached by the keyboard, in an order that ends where it began.
    const reached = new Set();
    for (let i = 0; i < 40; ++i) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => document.activeElement?.id ?? ""));
    }
    for (const id of ["space", "cut", "layer-1", "take", "tab-felt", "tab-text"]) assert.ok(reached.has(id), id);
    await page.locator("#tab-text").focus();
    await page.keyboard.press("Enter");
    assert.match(await page.locator("#lines").textContent(), /palpate: 1/);
    await picture(page, "container-text");
    // Check boxes switch a layer and the ports off.
    for (const box of ["#layer-1", "#ports-on"]) {
      await page.locator(box).focus();
      await page.keyboard.press("Space");
    }
    await settle(page);
    assert.ok((await look(page)).share < 0.05);
    await page.context().close();
    await served.stop();
  },

  async pages() {
    const served = new Served(scene("container"));
    const first = await open(served);
    await first.waitForFunction(() => window.palpatePage.last.steers);
    const second = await open(served);
    await second.waitForFunction(() => window.palpatePage.last.pages === 2);
    assert.equal(await second.locator("#steers").textContent(), "Another page steers. (2 pages)");
    const before = (await tick(second)).told;
    await second.evaluate(() => {
      window.palpatePage.told = [0.01, 0, 0];
      window.palpatePage.line.to([0.01, 0, 0]);
    });
    await settle(second, 10);
    assert.deepEqual((await tick(second)).told, before);
    await first.context().close();
    await second.waitForFunction(() => !window.palpatePage.last.steered);
    await second.locator("#take").click();
    await second.waitForFunction(() => window.palpatePage.last.steers);
    await second.context().close();
    // The loop goes on without a page.
    const third = await open(served);
    const from = (await tick(third)).n;
    await third.waitForFunction((n) => window.palpatePage.last.tick.n > n + 100, from);
    await third.context().close();
    await served.stop();
  },

  async replay() {
    const record = path.join(out, "insert.npy");
    const made = spawnSync(palpate, ["touch", scene("container"), "--insert", "0,0,60", "0,0,-45", "--back",
      "--record", record, "--force", "--json"], { encoding: "utf8" });
    assert.equal(made.status, 0, made.stderr);
    const served = new Served(scene("container"), "--replay", record);
    const page = await open(served);
    await page.waitForFunction(() => window.palpatePage.last.steers);
    const row = () => page.evaluate(() => window.palpatePage.last.row);
    assert.equal(await row(), 0);
    await page.locator("#row").focus();
    for (let i = 1; i <= 3; ++i) {
      await page.keyboard.press("ArrowRight");
      await page.waitForFunction((wanted) => window.palpatePage.last.row === wanted, i);
    }
    await page.keyboard.press("ArrowLeft");
    await page.waitForFunction(() => window.palpatePage.last.row === 2);
    // The hand is the record's: keys turn the view, and a still picture is not drawn again.
    assert.equal(await page.locator("#steers").textContent(), "This page plays the record.");
    assert.ok(await page.locator(".keys.leading").isHidden());
    // Where drawing is slow, a picture of coarse surfaces is followed by one of whole ones.
    await page.waitForFunction(() => window.palpatePage.space.detail.isWhole);
    await settle(page);
    const drawn = () => page.evaluate(() => window.palpatePage.space.drawn);
    const still = await drawn();
    await settle(page, 10);
    assert.equal(await drawn(), still);
    const told = await page.evaluate(() => window.palpatePage.told);
    await page.locator("#space").focus();
    await page.keyboard.down("ArrowLeft");
    await page.waitForFunction((before) => window.palpatePage.space.drawn > before, still);
    await page.keyboard.up("ArrowLeft");
    assert.deepEqual(await page.evaluate(() => window.palpatePage.told), told);
    await page.locator("#play").click();
    await page.waitForFunction(() => window.palpatePage.last.row === window.palpatePage.words.rows - 1);
    assert.equal(await page.locator("#log li").count(), 2);
    // Back to the moment in which the hand pushes into the bottom.
    await page.evaluate(() => {
      const slider = document.getElementById("row");
      slider.value = slider.max / 2;
      slider.dispatchEvent(new Event("input"));
    });
    await page.waitForFunction(() => window.palpatePage.last.tick.region === 1 && window.palpatePage.last.tick.contact);
    await picture(page, "replay");
    await page.context().close();
    await served.stop();
  },

  async tour() {
    // Somebody who was never here.
    const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
    const served = new Served(scene("container"));
    const page = await open(served, context);
    await page.waitForFunction(() => window.palpatePage.last.steers);
    const title = () => page.locator("#tour-title").textContent();
    assert.ok(await page.locator("#tour").isVisible());
    assert.equal(await title(), "1 of 4: Lead the hand");
    await picture(page, "tour");
    // The keys are the hand's, and a step says when it was done.
    await page.keyboard.down("ArrowDown");
    await page.waitForFunction(() => document.getElementById("tour-done").textContent === "Done.");
    await page.keyboard.up("ArrowDown");
    // The next one by the keyboard alone.
    const focus = () => page.evaluate(() => document.activeElement?.id ?? "");
    for (let i = 0; i < 40 && (await focus()) !== "tour-next"; ++i) await page.keyboard.press("Tab");
    assert.equal(await focus(), "tour-next");
    await page.keyboard.press("Enter");
    assert.equal(await title(), "2 of 4: Dip into the syrup");
    await page.keyboard.press("Escape");
    assert.ok(await page.locator("#tour").isHidden());
    assert.equal(await focus(), "space");
    await page.close();
    await served.stop();
    // Never again by itself, though the next server has another port; but when it is asked for.
    const again = new Served(scene("container"));
    assert.notEqual(new URL(await again.url).port, new URL(await served.url).port);
    const later = await open(again, context);
    assert.ok(await later.locator("#tour").isHidden());
    await later.locator("#tour-open").focus();
    await later.keyboard.press("Enter");
    assert.ok(await later.locator("#tour").isVisible());
    for (let i = 1; i <= 4; ++i) await later.locator("#tour-next").click();
    assert.ok(await later.locator("#tour").isHidden());
    await context.close();
    await again.stop();
  },

  async edits() {
    const folder = path.join(out, "edited");
    rmSync(folder, { recursive: true, force: true });
    mkdirSync(folder, { recursive: true });
    const file = path.join(folder, "bowl.yaml");
    const text = (name, more = "") => `palpate: 1
length: mm
fields:
  bowl: {sphere: {center: [0, 0, 0], radius: 40}}
  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}
materials:
  glass: {stiffness: 1500 N/m}
layers:
${more}  - {name: ${name}, inside: {intersection: [bowl, brim]}, wall: glass}
ports:
  - {name: mouth, between: [outside, ${name}], on: brim}
`;
    writeFileSync(file, text("liquid"));
    const served = new Served(file);
    const first = await open(served);
    const second = await open(served);
    const color = (page, name) =>
      page.evaluate((wanted) => {
        const row = [...document.querySelectorAll("#layers li")].find((li) => li.querySelector(".name")?.textContent === wanted);
        return row ? getComputedStyle(row.querySelector(".swatch")).backgroundColor : null;
      }, name);
    const before = await color(first, "liquid");
    assert.ok(before);

    // A layer with a new name, in the color of the second one: there is a shell around it now.
    const edited = text("juice", "  - {name: shell, inside: {sphere: {center: [0, 0, 0], radius: 45}}}\n");
    writeFileSync(`${file}~`, edited.replace("outside", "shell"));
    renameSync(`${file}~`, file);
    for (const page of [first, second]) {
      await page.waitForFunction(
        () => window.palpatePage.words.number === 1 && window.palpatePage.shown === window.palpatePage.words.regions.length,
      );
      assert.equal(await color(page, "liquid"), null);
      assert.notEqual(await color(page, "juice"), before);
      await page.waitForFunction(() => document.querySelector("#lines").textContent.includes("name: juice"));
      assert.match(await page.locator("#transitions").textContent(), /shell.*mouth.*juice/);
      assert.ok(await page.locator("#edit").isHidden());
    }
    await picture(first, "edits-felt");

    // What cannot be compiled: the error at its line, and the scene goes on.
    writeFileSync(file, edited.replace("stiffness: 1500", "stiffnes: 900"));
    for (const page of [first, second]) {
      await page.locator("#edit.bad").waitFor();
      assert.match(await page.locator("#edit").textContent(), /^Line 7: .*stiffnes/);
      await page.locator("#tab-text").click();
      assert.deepEqual(await page.locator("#lines li.bad").allTextContents(), ["  glass: {stiffnes: 900 N/m}"]);
      assert.equal(await page.evaluate(() => window.palpatePage.words.number), 1);
      const from = (await tick(page)).n;
      await page.waitForFunction((n) => window.palpatePage.last.tick.n > n + 100, from);
    }
    await picture(first, "edits-refused");

    // One that comes now sees the scene that is felt, and what is wrong with the file.
    const late = await open(served);
    assert.ok(await color(late, "juice"));
    await late.locator("#edit.bad").waitFor();

    // Mended.
    writeFileSync(file, text("water"));
    for (const page of [first, second, late]) {
      await page.waitForFunction(() => window.palpatePage.words.number === 2);
      await page.locator("#edit").waitFor({ state: "hidden" });
      assert.equal(await color(page, "water"), before);
      assert.equal(await page.locator("#lines li.bad").count(), 0);
    }
    assert.equal(served.err.match(/the scene goes on as it was/g).length, 1, served.err);
    for (const page of [first, second, late]) await page.context().close();
    await served.stop();
  },

  async head() {
    const { served, page } = await layers("head");
    assert.equal(await page.evaluate(() => window.palpatePage.marks.ports.length), 3);
    // The coronal slice at the probe is there from the start, the others when they are asked for.
    await page.waitForFunction(() => window.palpatePage.slices.slices.length === 3);
    const slice = (axis) =>
      page.evaluate((wanted) => {
        const found = window.palpatePage.slices.slices.find((each) => each.axis === wanted);
        const shades = found.mesh.visible ? new Set(found.mesh.material.map.image.data).size : 0;
        return { shown: found.shown, visible: found.mesh.visible, shades, at: found.mesh.position.getComponent(wanted) };
      }, axis);
    await page.waitForFunction(() => window.palpatePage.slices.slices.every((each) => each.axis !== 1 || each.shown >= 0));
    await settle(page);
    assert.ok(!(await slice(0)).visible && !(await slice(2)).visible);
    for (const name of ["x", "z"]) {
      await page.locator(`#slice-${name}`).focus();
      await page.keyboard.press("Space");
    }
    await page.waitForFunction(() => window.palpatePage.slices.slices.every((each) => each.mesh.visible));
    const probe = (await tick(page)).proxy;
    const voxel = 1e-3; // [m] of this scan
    for (const axis of [0, 1, 2]) {
      const now = await slice(axis);
      // The probe touches the crown, where an axial slice holds little more than scalp.
      assert.ok(now.shades > (axis === 2 ? 10 : 50), JSON.stringify(now));
      assert.ok(Math.abs(now.at - probe[axis]) < voxel, `${JSON.stringify(now)} ${probe}`);
    }
    // Pressed beyond what the device can give, the page says so.
    await page.waitForFunction(() => Math.hypot(...window.palpatePage.last.tick.force) > 1.01 * window.palpatePage.words.max_force);
    await page.waitForFunction(() => document.getElementById("force").textContent.endsWith("; the device gives 3.3 N"));
    await picture(page, "head-slices");
    // A slider leads its slice elsewhere.
    const before = (await slice(2)).shown;
    await page.locator("#slice-list input[type=range]").first().focus();
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction((old) => window.palpatePage.slices.slices[0].shown === old + 1, before);
    assert.ok(!(await page.locator("#slices-follow").isChecked()));
    await page.context().close();
    await served.stop();
  },

  async needle() {
    const { served, page } = await layers("needle");
    await page.context().close();
    await served.stop();
    // In and half way out again: the shaft is held, and the wall has a hole.
    const record = path.join(out, "needle.npy");
    const made = spawnSync(palpate, ["touch", scene("needle"), "--insert", "-100,-42,60", "-12,-18,8",
      "--record", record, "--force", "--json"], { encoding: "utf8" });
    assert.equal(made.status, 0, made.stderr);
    const replay = new Served(scene("needle"), "--replay", record);
    const past = await open(replay);
    await past.waitForFunction(() => window.palpatePage.last.steers);
    assert.ok(await past.locator("#mark-shaft").isHidden());
    await past.locator("#row").focus();
    await past.keyboard.press("End");
    await past.waitForFunction(() => window.palpatePage.last.row === window.palpatePage.words.rows - 1);
    await past.locator("#mark-shaft").waitFor({ state: "visible" });
    await past.locator("#mark-hole").waitFor({ state: "visible" });
    const last = await tick(past);
    assert.equal(last.holes.length, 1);
    assert.match(await past.locator("#content").textContent(), /^nucleus/);
    // The shaft lies along the way in, and begins where the brain does: within the burr hole.
    const way = [88, 24, -52];
    const along = last.proxy.map((v, i) => v - last.shaft[i]);
    const cosine = along.reduce((sum, v, i) => sum + v * way[i], 0) / Math.hypot(...along) / Math.hypot(...way);
    assert.ok(cosine > 0.99, `${along}`);
    await picture(past, "needle-inside");
    await past.context().close();
    await replay.stop();
  },

  async pelvis() {
    const scans = process.env.PALPATE_SCANS ?? path.join(root, "../shared/data");
    const from = path.join(scans, "pelvis");
    if (!existsSync(from)) return `left out for want of ${from}`;
    const file = path.join(out, "pelvis.yaml");
    const made = spawnSync(palpate, ["import", path.join(from, "label.mhd"), "--names", path.join(from, "labels.csv"),
      "--body", path.join(from, "mask.mhd"), "--region", "muscle=5-28", "--region", "bone=1-4", "-o", file, "--force",
      "--json"], { encoding: "utf8" });
    assert.equal(made.status, 0, made.stderr);
    const { served, page } = await layers(file);
    await page.context().close();
    await served.stop();
  },

  async colors() {
    const css = readFileSync(path.join(root, "tools/page/src/style.css"), "utf8");
    const color = (name) => {
      const found = new RegExp(`--${name}: #([0-9a-f]{6});`).exec(css);
      assert.ok(found, name);
      return [0, 2, 4].map((i) => parseInt(found[1].slice(i, i + 2), 16) / 255);
    };
    const linear = (c) => c.map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    const luminance = (c) => 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    const contrast = (a, b) => {
      const [high, low] = [luminance(a), luminance(b)].sort((p, q) => q - p);
      return (high + 0.05) / (low + 0.05);
    };
    const get = (name) => linear(color(name));
    // WCAG 2.1: 4.5 for text, 3 for graphics.
    for (const ink of ["ink", "faint"]) assert.ok(contrast(get(ink), get("panel")) >= 4.5, ink);
    const marks = ["hip", "proxy", "force", "told"];
    for (const mark of [...marks, "port", "hole", "shaft"]) assert.ok(contrast(get(mark), get("ground")) >= 3, mark);
    // Marks are distinguishable with each kind of complete color blindness: Machado, Oliveira and Fernandes 2009.
    const blind = {
      protan: [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
      deutan: [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
      tritan: [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
    };
    const lab = (c) => {
      const xyz = [
        (0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505,
        0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2],
        (0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089,
      ].map((v) => (v > 0.008856 ? Math.cbrt(v) : 7.787 * v + 16 / 116));
      return [116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])];
    };
    for (const [kind, matrix] of Object.entries(blind)) {
      const seen = (name) =>
        lab(matrix.map((r) => Math.min(Math.max(r[0] * get(name)[0] + r[1] * get(name)[1] + r[2] * get(name)[2], 0), 1)));
      for (const a of marks) {
        for (const b of marks) {
          if (a >= b) continue;
          const [p, q] = [seen(a), seen(b)];
          // Ten times the difference that is just visible side by side (about 2.3).
          const apart = Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
          assert.ok(apart >= 23, `${a} and ${b} for ${kind}: ${apart}`);
        }
      }
    }
  },
};

/** A scene of anatomy, by its name or its file, up to the first touch. */
async function layers(which) {
  const name = path.basename(which, ".yaml");
  const served = new Served(path.isAbsolute(which) ? which : scene(which));
  const page = await open(served);
  await page.waitForFunction(() => window.palpatePage.last.steers);
  await picture(page, `${name}-start`);
  // Towards the middle, until something is touched.
  await page.evaluate(() => {
    const { lo, hi } = window.palpatePage.words.box;
    window.palpatePage.told = lo.map((v, i) => (v + hi[i]) / 2);
    window.palpatePage.changed();
  });
  await page.waitForFunction(() => Math.hypot(...window.palpatePage.last.tick.force) > 0.05);
  await picture(page, `${name}-touched`);
  return { served, page };
}

mkdirSync(out, { recursive: true });
browser = await chromium.launch({
  executablePath: process.env.PALPATE_CHROMIUM ?? "/usr/bin/chromium",
  // Software rendering, so that it runs anywhere; the sandbox needs a user that is not root.
  args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...(process.getuid() === 0 ? ["--no-sandbox"] : [])],
});
let passed = 0;
let failed = 0;
for (const [name, run] of Object.entries(tests)) {
  if (names.length > 0 && !names.includes(name)) continue;
  const began = Date.now();
  try {
    const note = await run();
    assert.deepEqual(asked, [], "the page asks other servers");
    assert.deepEqual(broken, [], "the page failed");
    ++passed;
    console.log(`ok      ${name} (${note ?? `${((Date.now() - began) / 1000).toFixed(1)} s`})`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}: ${error.stack}`);
  }
  broken.length = 0;
  asked.length = 0;
  for (const served of [...Served.running]) await served.stop();
}
await browser.close();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed === 0 && passed > 0 ? 0 : 1);
