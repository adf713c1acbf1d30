// The page of `palpate view`.

import "./style.css";
import { Edits } from "./edits";
import { Felt } from "./felt";
import { Layers } from "./layers";
import { Marks } from "./marks";
import { Scrubber } from "./scrubber";
import { Slices } from "./slices";
import { Space, type Cut } from "./space";
import { Steering } from "./steering";
import { Tour } from "./tour";
import { Line, fetchScene, fetchSurface, type SceneWords, type Snapshot, type Vector } from "./wire";

const byId = (id: string): HTMLElement => document.getElementById(id)!;

const sayEvery = 15; // [ms] least time between messages that are not sent with a frame

class Page {
  readonly canvas = byId("space") as HTMLCanvasElement;
  readonly space = new Space(this.canvas);
  readonly layers = new Layers(byId("layers"), this.space);
  readonly felt = new Felt();
  readonly marks = new Marks(this.space);
  readonly slices = new Slices(this.space);
  readonly tour = new Tour(() => this.canvas.focus());
  readonly edits = new Edits();
  readonly scrubber = new Scrubber((row) => this.line.row(row));
  readonly line: Line;
  readonly steering: Steering;
  words: SceneWords | null = null;
  last: Snapshot | null = null;
  told: Vector = [0, 0, 0];
  start: Vector = [0, 0, 0];
  /** Number of surfaces requested, in the order of regions. */
  asked = 0;
  /** Number of surfaces shown. */
  shown = 0;
  private hasMoved = false;
  private saidAt = 0;
  private isLoading = false;
  private isOver = false;
  private hasAsked = false;

  constructor() {
    this.line = new Line(
      (snapshot) => this.take(snapshot),
      () => this.end(),
    );
    this.steering = new Steering(this.canvas, this.space, this);
    const cut = byId("cut") as HTMLSelectElement;
    cut.addEventListener("change", () => this.space.setCut(cut.value as Cut));
    this.space.setCut(cut.value as Cut);
    byId("take").addEventListener("click", () => this.line.steer(!(this.last?.steers ?? false)));
    for (const name of ["felt", "text"]) {
      byId(`tab-${name}`).addEventListener("click", () => this.openTab(name));
    }
    void this.load();
    const frame = () => {
      this.frame();
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
    this.canvas.focus();
  }

  /** Called by Steering. Sends at once, so that the hand does not wait for a slow frame. */
  changed(): void {
    this.hasMoved = true;
    if (performance.now() - this.saidAt > sayEvery) this.say();
  }

  private say(): void {
    if (!this.hasMoved || this.last?.steers !== true) return;
    this.hasMoved = false;
    this.saidAt = performance.now();
    this.line.to(this.told);
  }

  private frame(): void {
    this.steering.step();
    this.scrubber.step();
    this.say();
    this.slices.step(this.last?.tick?.proxy ?? null);
    this.space.draw();
    this.felt.draw();
  }

  private async load(): Promise<void> {
    this.isLoading = true;
    try {
      const words = await fetchScene();
      const isFirst = this.words === null;
      this.words = words;
      this.start = words.start;
      if (isFirst) this.told = [...words.start];
      document.body.classList.toggle("led", !this.leads);
      document.title = `${words.file} - Palpate`;
      byId("title").textContent = words.file;
      byId("device").textContent =
        words.mode === "replay" ? `recorded, ${words.device}` : `${words.device}, ${words.rate} ticks a second`;
      this.asked = 0;
      this.shown = 0;
      this.space.begin(words, !isFirst);
      this.layers.begin(words);
      this.marks.begin(words);
      this.slices.begin();
      this.tour.begin(words);
      this.felt.begin(words);
      this.scrubber.begin(words);
    } catch (error) {
      this.notice(`The scene could not be fetched: ${String(error)}`);
    }
    this.isLoading = false;
  }

  private take(snapshot: Snapshot): void {
    this.last = snapshot;
    this.edits.take(snapshot.edit);
    const words = this.words;
    if (words === null) return;
    if (snapshot.scene !== words.number) {
      if (!this.isLoading) void this.load();
      return;
    }
    while (this.asked < Math.min(snapshot.surfaces, words.regions.length)) void this.addSurface(words, this.asked++);
    // The first page to come steers.
    if (!this.hasAsked && !snapshot.steered && words.mode !== "device") this.line.steer(true);
    this.hasAsked = true;
    if (snapshot.ports) void this.marks.come(words);
    if (snapshot.slices) void this.slices.come(words.number);
    this.showPlace(snapshot, words);
    if (snapshot.tick === undefined) return;
    const isReplay = words.mode === "replay";
    this.space.showTick(snapshot.tick);
    this.marks.showTick(snapshot.tick);
    this.tour.showTick(snapshot.tick);
    this.layers.mark(snapshot.tick.region);
    this.felt.show(snapshot.tick, isReplay);
  }

  private async addSurface(words: SceneWords, region: number): Promise<void> {
    const about = words.regions[region]!;
    if (about.color !== null) {
      const surface = await fetchSurface(words.number, region);
      if (this.words !== words) return;
      const look = this.layers.look(about.name, region, words.regions.length);
      if (surface !== null) this.space.addSurface(region, surface, about.color, look.opacity, look.visible);
    }
    if (++this.shown === words.regions.length) this.space.complete();
  }

  private showPlace(snapshot: Snapshot, words: SceneWords): void {
    const others = snapshot.pages > 1 ? ` (${snapshot.pages} pages)` : "";
    const isReplay = words.mode === "replay";
    const does = isReplay ? "plays the record" : "steers";
    let text = `Nobody ${does}.`;
    if (snapshot.steers) text = `This page ${does}.`;
    else if (snapshot.steered) text = `Another page ${does}.`;
    if (words.mode === "device") text = "A hand moves the device.";
    byId("steers").textContent = text + others;
    const take = byId("take") as HTMLButtonElement;
    const grasp = isReplay ? "Take over" : "Steer";
    take.textContent = snapshot.steers ? "Let go" : grasp;
    take.hidden = words.mode === "device";
    take.disabled = !snapshot.steers && snapshot.steered;
  }

  private openTab(name: string): void {
    for (const other of ["felt", "text"]) {
      byId(other).hidden = other !== name;
      byId(`tab-${other}`).setAttribute("aria-selected", String(other === name));
    }
  }

  private notice(text: string): void {
    const notice = byId("notice");
    notice.textContent = text;
    notice.hidden = text === "";
  }

  private end(): void {
    this.isOver = true;
    this.notice("palpate view has ended. What is shown is the last that it said; start it again for a new page.");
  }

  get leads(): boolean {
    return this.words?.mode !== "replay" && this.words?.mode !== "device";
  }

  get over(): boolean {
    return this.isOver;
  }
}

declare global {
  interface Window {
    palpatePage: Page;
  }
}
window.palpatePage = new Page();
