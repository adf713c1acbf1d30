// The colors of forces.

/** Lightness increases, so that colors need not be seen; the first one stands out from the background. */
const stops: [number, number, number][] = [
  [0.45, 0.5, 0.85],
  [0.35, 0.6, 0.85],
  [0.3, 0.7, 0.75],
  [0.4, 0.8, 0.6],
  [0.7, 0.88, 0.35],
  [0.99, 0.91, 0.15],
];

/** Red, green and blue for a share from 0 to 1. */
export function colorOfShare(share: number): [number, number, number] {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const below = Math.min(Math.floor(at), stops.length - 2);
  const part = at - below;
  const a = stops[below]!;
  const b = stops[below + 1]!;
  return [a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])];
}
