// Strip charts: a number over the last seconds.

const span = 10; // [s]

interface Sample {
  t: number;
  value: number;
}

export class StripChart {
  private samples: Sample[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly scale: HTMLElement,
    private readonly unit: string,
    private readonly color: string,
  ) {}

  /** A time before the last one starts a new chart: the user went back in a record. */
  add(t: number, value: number): void {
    const last = this.samples[this.samples.length - 1];
    if (last !== undefined && t < last.t) this.samples = [];
    if (last !== undefined && t === last.t) return;
    this.samples.push({ t, value });
    while (this.samples.length > 0 && this.samples[0]!.t < t - span) this.samples.shift();
  }

  draw(): void {
    const { canvas } = this;
    const ratio = window.devicePixelRatio;
    const width = Math.round(canvas.clientWidth * ratio);
    const height = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const pen = canvas.getContext("2d");
    if (pen === null) return;
    pen.clearRect(0, 0, width, height);
    const last = this.samples[this.samples.length - 1];
    if (last === undefined) return;
    let low = 0;
    let high = 0;
    for (const { value } of this.samples) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    if (high - low < 1e-9) high = low + 1;
    const x = (t: number) => width * (1 - (last.t - t) / span);
    const y = (value: number) => 3 + (height - 6) * (1 - (value - low) / (high - low));
    pen.strokeStyle = "#6b7684";
    pen.lineWidth = ratio;
    pen.beginPath();
    pen.moveTo(0, y(0));
    pen.lineTo(width, y(0));
    pen.stroke();
    pen.strokeStyle = this.color;
    pen.lineWidth = 1.5 * ratio;
    pen.beginPath();
    for (const { t, value } of this.samples) pen.lineTo(x(t), y(value));
    pen.stroke();
    this.scale.textContent = `${low.toPrecision(3)} to ${high.toPrecision(3)} ${this.unit}, ${span} s`;
  }
}
