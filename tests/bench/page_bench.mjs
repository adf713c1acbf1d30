// What the page of `palpate view` costs, and what it costs the loop:
//   node tests/bench/page_bench.mjs PALPATE PAGE_FOLDER [SCENE] [SECONDS] [ROUNDS]
// PAGE_FOLDER holds the node_modules that tools/page/build.sh has installed. README.md says what is printed.
import { spawn } from "node:child_process";
import net from "node:net";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
const [palpate, pageFolder, scene = path.join(root, "data/scenes/head.yaml"), secondsText = "20", roundsText = "3"] =
  process.argv.slice(2);
const seconds = Number(secondsText);
const rounds = Number(roundsText);
const require = createRequire(path.join(path.resolve(pageFolder), "package.json"));
const { chromium } = require("playwright-core");

const patience = 600_000; // [ms]
const connections = 1000; // of a storm
const slowReaders = 12; // of the 16 pages that the server takes
const opening = 15; // [s] of each run, for a page to come up

const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const quantile = (values, share) => [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(share * values.length))];
const number = (value, digits = 1) => value?.toFixed(digits) ?? "-";
const megabytes = (bytes) => `${number(bytes / 1e6, 2)} MB`;

/** `palpate view` until it is stopped, or for some seconds. */
class Served {
  constructor(...more) {
    this.began = performance.now();
    this.process = spawn(palpate, ["view", scene, "--no-open", "--json", ...more], { stdio: ["ignore", "pipe", "pipe"] });
    this.out = "";
    this.err = "";
    this.process.stdout.on("data", (bytes) => (this.out += bytes));
    this.ended = new Promise((resolve) => this.process.on("exit", resolve));
    this.url = new Promise((resolve, reject) => {
      this.process.stderr.on("data", (bytes) => {
        this.err += bytes;
        const found = /^http:\S+$/m.exec(this.err);
        if (found) resolve(found[0]);
      });
      void this.ended.then((code) => reject(new Error(`palpate view ended with ${code}: ${this.err}${this.out}`)));
    });
    this.url.catch(() => {});
    // Whatever ends the bench leaves no server behind.
    process.once("exit", () => this.process.kill("SIGTERM"));
  }
  /** What it reports at its end. */
  async report() {
    await this.ended;
    return JSON.parse(this.out);
  }
}

const browser = await chromium.launch({
  executablePath: process.env.PALPATE_CHROMIUM ?? "/usr/bin/chromium",
  args: ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...(process.getuid() === 0 ? ["--no-sandbox"] : [])],
});

/** A page of the server, and the bytes that its line brings. */
async function open(served) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  await context.addCookies([{ name: "palpate_tour", value: "seen", url: "http://127.0.0.1/" }]);
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  const line = { bytes: 0, messages: 0 };
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => {
      line.bytes += payload.length;
      ++line.messages;
    }),
  );
  await page.goto(await served.url);
  return { page, line };
}

/** [ms] since the server was started, of what comes first and last. */
async function firstPicture() {
  const served = new Served("--seconds", "600");
  await served.url;
  const address = performance.now() - served.began;
  const { page } = await open(served);
  const at = async (isThere) => {
    await page.waitForFunction(isThere, undefined, { polling: "raf" });
    return performance.now() - served.began;
  };
  // A picture is drawn in the frame after its parts are there.
  const first = await at(() => window.palpatePage?.shown > 1 && window.palpatePage.space.frames > 1);
  const all = await at(() => window.palpatePage.shown === window.palpatePage.words.regions.length);
  const marks = await at(() => window.palpatePage.marks.isComplete);
  const files = await page.evaluate(() =>
    performance.getEntriesByType("resource").concat(performance.getEntriesByType("navigation")).reduce((sum, file) => sum + file.transferSize, 0),
  );
  await page.context().close();
  served.process.kill("SIGINT");
  await served.ended;
  return { address, first, all, marks, files };
}

/** Frames, delays and bytes while the hand is led around. */
async function moving(page, line) {
  const before = { ...line };
  const began = performance.now();
  const seen = await page.evaluate(async (duration) => {
    const here = window.palpatePage;
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    const { lo, hi } = here.words.box;
    const middle = lo.map((v, i) => (v + hi[i]) / 2);
    const radius = 0.25 * Math.min(hi[0] - lo[0], hi[1] - lo[1]);
    const end = performance.now() + duration;
    const from = here.space.drawn;
    const start = performance.now();
    const told = [];
    const drawn = [];
    for (let i = 0; performance.now() < end; ++i) {
      const place = [middle[0] + radius * Math.cos(0.05 * i), middle[1] + radius * Math.sin(0.05 * i), middle[2]];
      const t = performance.now();
      here.told = place;
      here.line.to(place);
      const isHeard = () => here.last.tick.told.every((v, axis) => Math.abs(v - place[axis]) < 1e-9);
      // Messages come between frames: looked at as often as can be.
      const channel = new MessageChannel();
      while (!isHeard() && performance.now() < end) {
        await new Promise((resolve) => {
          channel.port1.onmessage = resolve;
          channel.port2.postMessage(0);
        });
      }
      channel.port1.close();
      if (!isHeard()) break;
      told.push(performance.now() - t);
      const count = here.space.drawn;
      while (here.space.drawn === count) await frame();
      drawn.push(performance.now() - t);
    }
    return { frames: here.space.drawn - from, took: performance.now() - start, told, drawn };
  }, 1000 * seconds);
  const took = (performance.now() - began) / 1000;
  return {
    rate: seen.frames / (seen.took / 1000),
    told: seen.told,
    drawn: seen.drawn,
    messages: (line.messages - before.messages) / took,
    bytes: (line.bytes - before.bytes) / took,
  };
}

const cameAndGone = { opened: 0, slow: 0 };

/** Connections that are opened and killed, some in the middle of a request, beside readers that never read. */
async function storm(served) {
  const { port, pathname } = new URL(await served.url);
  const upgrade =
    `GET ${pathname}live HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\nOrigin: http://127.0.0.1:${port}\r\nUpgrade: websocket\r\n` +
    "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  const plain = `GET ${pathname} HTTP/1.1\r\nHost: 127.0.0.1:${port}\r\n\r\n`;
  const connect = () =>
    new Promise((resolve) => {
      const socket = net.connect(Number(port), "127.0.0.1", () => resolve(socket));
      socket.on("error", () => resolve(socket));
    });
  const readers = [];
  for (let i = 0; i < slowReaders; ++i) {
    const socket = await connect();
    socket.pause();
    socket.write(upgrade);
    readers.push(socket);
    ++cameAndGone.slow;
  }
  const gap = (900 * seconds) / connections; // [ms]
  for (let i = 0; i < connections; ++i) {
    const socket = await connect();
    if (i % 4 === 1) socket.write(plain.slice(0, 30));
    if (i % 4 === 2) socket.write(plain);
    if (i % 4 === 3) socket.write(upgrade);
    socket.resetAndDestroy();
    ++cameAndGone.opened;
    await wait(gap);
  }
  for (const socket of readers) socket.destroy();
}

console.log(`scene ${path.basename(scene)}, ${seconds} s a run, ${rounds} rounds; pages by software rendering (SwiftShader), 1280 x 720`);
await firstPicture(); // fills the cache of grids
const pictures = [];
for (let i = 0; i < rounds; ++i) pictures.push(await firstPicture());
for (const p of pictures) {
  console.log(
    `start: address ${number(p.address)} ms, first picture ${number(p.first)} ms, all layers ${number(p.all)} ms, ` +
      `ports ${number(p.marks)} ms; files and surfaces ${megabytes(p.files)}`,
  );
}

const looks = { "no page": async () => {}, "a page": null, storm };
looks["a page"] = async (served) => {
  const { page, line } = await open(served);
  await page.waitForFunction(() => window.palpatePage?.marks.isComplete && window.palpatePage.last.steers);
  const m = await moving(page, line);
  console.log(
    `page: ${number(m.rate)} frames a second; probe heard after ${number(quantile(m.told, 0.5))} ms (p50), ` +
      `${number(quantile(m.told, 0.99))} ms (p99); drawn after ${number(quantile(m.drawn, 0.5))} ms (p50), ` +
      `${number(quantile(m.drawn, 0.99))} ms (p99), of ${m.drawn.length}; line ${number(m.messages)} messages, ${number(m.bytes / 1000)} kB a second`,
  );
  await page.context().close();
};
for (let round = 0; round < rounds; ++round) {
  for (const [name, look] of Object.entries(looks)) {
    const served = new Served("--seconds", String(seconds + opening));
    await served.url;
    await look(served);
    const end = await served.report();
    const r = end.realtime;
    console.log(
      `${name}: ${r.overruns} overruns of ${end.ticks} ticks, late p99.9 ${number(r.late_ns.p999 / 1000)} us, at most ` +
        `${number(r.worst_lateness_s * 1e3, 2)} ms, elevated ${r.elevated}; ${end.page.connections} connections, ` +
        `${end.page.turned_away} turned away, ${megabytes(end.page.bytes_sent)} sent`,
    );
  }
}
console.log(`storms: ${cameAndGone.opened} connections opened and killed, ${cameAndGone.slow} readers that never read`);
await browser.close();
