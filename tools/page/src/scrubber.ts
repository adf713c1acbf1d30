// Moves through a record: a slider, play and pause, single ticks by the arrow keys.

import type { SceneWords } from "./wire";

const byId = (id: string): HTMLElement => document.getElementById(id)!;

export class Scrubber {
  private readonly slider = byId("row") as HTMLInputElement;
  private readonly button = byId("play") as HTMLButtonElement;
  private rows = 1;
  private rate = 1000; // [1/s] rows in real time
  private overview: number[] = [];
  private playedAt: number | null = null; // [ms] time of the last step while playing

  /** `onRow` is called with each row to show. */
  constructor(private readonly onRow: (row: number) => void) {
    this.slider.addEventListener("input", () => {
      this.playedAt = null;
      this.go(Number(this.slider.value));
    });
    this.button.addEventListener("click", () => {
      if (this.playedAt === null && this.row >= this.rows - 1) this.go(0);
      this.playedAt = this.playedAt === null ? performance.now() : null;
      this.label();
    });
  }

  begin(words: SceneWords): void {
    byId("scrub").hidden = words.rows === null;
    this.rows = words.rows ?? 1;
    this.slider.max = String(this.rows - 1);
    this.overview = words.overview ?? [];
    this.drawOverview();
    this.label();
  }

  step(): void {
    if (this.playedAt === null) return;
    const now = performance.now();
    const rows = Math.floor(((now - this.playedAt) / 1000) * this.rate);
    if (rows === 0) return;
    this.playedAt += (1000 * rows) / this.rate;
    const next = Math.min(this.row + rows, this.rows - 1);
    if (next === this.rows - 1) this.playedAt = null;
    this.go(next);
  }

  private get row(): number {
    return Number(this.slider.value);
  }
  private go(row: number): void {
    this.slider.value = String(row);
    this.label();
    this.onRow(row);
  }
  private label(): void {
    byId("row-number").textContent = `row ${this.row + 1} of ${this.rows}`;
    this.button.textContent = this.playedAt === null ? "Play" : "Pause";
  }

  private drawOverview(): void {
    const canvas = byId("overview") as HTMLCanvasElement;
    canvas.width = Math.max(canvas.clientWidth, 1);
    canvas.height = Math.max(canvas.clientHeight, 1);
    const pen = canvas.getContext("2d");
    if (pen === null) return;
    const most = Math.max(...this.overview, 1e-9);
    pen.strokeStyle = "#f0e442";
    pen.beginPath();
    this.overview.forEach((force, i) => {
      pen.lineTo((canvas.width * (i + 0.5)) / this.overview.length, (canvas.height - 2) * (1 - force / most) + 1);
    });
    pen.stroke();
  }
}
