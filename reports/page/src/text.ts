// Numbers as text for readers.

/** Number with `n` significant digits: a decimal from 0.001 to 100,000, otherwise with a power of ten. */
export function digits(value: number, n = 3): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e5) {
    const [mantissa, power] = value.toExponential(n - 1).split("e");
    return `${mantissa}×10${raised(Number(power))}`;
  }
  return Number(value.toPrecision(n)).toFixed(Math.max(0, n - 1 - Math.floor(Math.log10(Number(size.toPrecision(n))))));
}

export function raised(power: number): string {
  return String(power).replace(/./g, (c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]));
}

export function duration(seconds: number, n = 3): string {
  const [scale, unit] =
    seconds >= 7200 ? [3600, "h"] : seconds >= 1 ? [1, "s"] : seconds >= 1e-3 ? [1e-3, "ms"] : seconds >= 1e-6 ? [1e-6, "µs"] : [1e-9, "ns"];
  return `${digits(seconds / scale, n)} ${unit}`;
}

export const percent = (value: number, n = 2): string => (value >= 1e-5 ? `${digits(100 * value, n)} %` : digits(value, n));

export const whole = (value: number): string => value.toLocaleString("en-US");

export const plural = (n: number, word: string): string => `${whole(n)} ${word}${n === 1 ? "" : "s"}`;

/** Tick label of a logarithmic axis: a decimal from 0.0001 to below 10,000, otherwise with a power of ten. */
export function tick(value: number): string {
  const power = Math.floor(Math.log10(value) + 1e-9);
  if (power >= -4 && power <= 3) return String(Number(value.toPrecision(3)));
  const mantissa = Math.round(value / 10 ** power);
  return `${mantissa === 1 ? "" : `${mantissa}×`}10${raised(power)}`;
}

/** Ticks of a logarithmic axis, at most about `room`: decades, with 2 and 5, or 3, between a few decades. */
export function logTicks(low: number, high: number, room: number): number[] {
  const decades = Math.log10(high / low);
  const steps = decades * 3 <= room ? [1, 2, 5] : decades * 2 <= room ? [1, 3] : [1];
  const every = Math.max(1, Math.ceil(decades / room));
  const out: number[] = [];
  for (let power = Math.floor(Math.log10(low)) - 1; power <= Math.log10(high) + 1; power++)
    for (const step of steps) {
      const at = step * 10 ** power;
      if (at >= low * 0.999 && at <= high * 1.001 && (steps.length > 1 || power % every === 0)) out.push(Number(at.toPrecision(3)));
    }
  return out;
}

export function linearTicks(low: number, high: number, room: number): number[] {
  const raw = (high - low) / room;
  const decade = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((s) => s * decade).find((s) => s >= raw * 0.999)!;
  const out: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++) out.push(Number((k * step).toPrecision(12)));
  return out;
}

export function list(items: string[]): string {
  return items.length < 2 ? items.join("") : `${items.slice(0, -1).join(", ")} and ${items[items.length - 1]}`;
}

/** Text as the id of an element. */
export const slug = (text: string): string => text.toLowerCase().replace(/[^a-z0-9]+/g, "-");
