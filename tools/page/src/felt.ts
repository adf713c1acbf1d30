// Words and numbers for the present tick, and the table of transitions.

import type { SceneWords, Tick } from "./wire";
import { StripChart } from "./charts";

const byId = (id: string): HTMLElement => document.getElementById(id)!;
const mostLines = 60;

export class Felt {
  private words: SceneWords | null = null;
  private rows: HTMLTableRowElement[] = [];
  private last: { from: number; to: number; port: number | null } | null = null;
  private readonly charts: [StripChart, StripChart, StripChart];

  constructor() {
    const chart = (name: string, unit: string, color: string) =>
      new StripChart(byId(`chart-${name}`) as HTMLCanvasElement, byId(`${name}-scale`), unit, color);
    this.charts = [
      chart("force", "N", "#f0e442"),
      chart("depth", "mm", "#56b4e9"),
      chart("work", "mJ", "#e69f00"),
    ];
  }

  begin(words: SceneWords): void {
    this.words = words;
    this.last = null;
    const cell = (text: string) => {
      const made = document.createElement("td");
      // Long names may break where their words do.
      made.textContent = text.replaceAll("_", "_\u200b");
      return made;
    };
    this.rows = words.transitions.map((t) => {
      const row = document.createElement("tr");
      row.append(
        cell(this.region(t.from)),
        cell(t.port === null ? "no wall" : this.port(t.port)),
        cell(this.region(t.to)),
        cell(t.when.length === 0 ? "always" : t.when.join(", ")),
        cell(""),
      );
      return row;
    });
    document.querySelector("#transitions tbody")!.replaceChildren(...this.rows);
  }

  private region(id: number): string {
    return this.words?.regions[id]?.name ?? "?";
  }
  private port(id: number): string {
    return this.words?.ports[id] ?? "?";
  }

  /** `isAll`: `tick` holds all entries of the session, not only those since the last call. */
  show(tick: Tick, isAll: boolean): void {
    const words = this.words;
    if (words === null) return;
    const region = byId("region");
    if (region.textContent !== this.region(tick.region)) region.textContent = this.region(tick.region);
    region.classList.toggle("touches", tick.contact);
    const strength = Math.hypot(...tick.force);
    const depth = tick.hip.includes(null)
      ? 0
      : Math.hypot(...tick.proxy.map((x, i) => x - (tick.hip[i] as number)));
    byId("content").textContent = tick.content || "-";
    byId("wall").textContent = tick.wall || "-";
    const most = words.max_force ?? Infinity;
    byId("force").textContent = `${strength.toFixed(2)} N` + (strength > most ? `; the device gives ${most} N` : "");
    byId("depth").textContent = `${(1000 * depth).toFixed(2)} mm`;
    byId("time").textContent =
      `${(tick.ns / 1000).toFixed(1)} us, worst ${(tick.worst_ns / 1000).toFixed(0)} us, late ${tick.late}`;
    this.charts[0].add(tick.t, Math.max(strength, isAll ? 0 : tick.strongest));
    this.charts[1].add(tick.t, 1000 * depth);
    this.charts[2].add(tick.t, 1000 * tick.work);
    this.log(tick, isAll);
    words.transitions.forEach((t, index) => {
      const row = this.rows[index]!;
      const last = this.last;
      row.classList.toggle("from", t.from === tick.region);
      row.classList.toggle(
        "lit",
        last !== null && last.from === t.from && last.to === t.to && last.port === t.port,
      );
      const passed = t.port === null ? 0 : (tick.passed[t.port] ?? 0);
      row.cells[4]!.textContent = passed === 0 ? "" : String(Math.abs(passed));
    });
  }

  private log(tick: Tick, isAll: boolean): void {
    const list = byId("log");
    if (isAll) list.replaceChildren();
    for (const entry of isAll ? tick.entries.slice(-mostLines) : tick.entries) {
      this.last = { from: entry.from, to: entry.to, port: entry.port };
      const line = document.createElement("li");
      const how = entry.port === null ? "where no wall is" : `through ${this.port(entry.port)}`;
      const force = entry.force > 0 ? `, at ${entry.force.toFixed(2)} N` : "";
      line.textContent = `tick ${entry.tick}: ${this.region(entry.from)} to ${this.region(entry.to)} ${how}${force}`;
      list.prepend(line);
    }
    if (isAll && tick.entries.length === 0) this.last = null;
    while (list.childElementCount > mostLines) list.lastElementChild!.remove();
  }

  draw(): void {
    for (const chart of this.charts) chart.draw();
  }
}
