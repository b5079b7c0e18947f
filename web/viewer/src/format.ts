// Numbers as a person reads them.

// Three significant digits, no exponents between a thousandth and a million.
export function short(value: number): string {
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size === 0) return '0';
  if (size < 1e-3 || size >= 1e6) return value.toExponential(1).replace('e+', 'e');
  if (size >= 1000) return value.toFixed(0);
  return String(Number(value.toPrecision(3)));
}

// As on an axis: 12k, 1.5M.
export function compact(value: number): string {
  const size = Math.abs(value);
  if (size >= 1e6) return `${Number((value / 1e6).toPrecision(3))}M`;
  if (size >= 1e4) return `${Number((value / 1e3).toPrecision(3))}k`;
  return short(value);
}

// Stress with its unit, strain in percent; two digits.
export function readingText(value: number, what: 'stress' | 'strain'): string {
  const two = (number: number): string => short(Number(number.toPrecision(2)));
  if (what === 'strain') return `${two(100 * value)} %`;
  const size = Math.abs(value);
  if (size >= 1e9) return `${two(value / 1e9)} GPa`;
  if (size >= 1e6) return `${two(value / 1e6)} MPa`;
  if (size >= 1e3) return `${two(value / 1e3)} kPa`;
  return `${two(value)} Pa`;
}

export function fixed(value: number, digits: number): string {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

// m:ss.hh, or with hours once there are some.
export function clock(seconds: number): string {
  const whole = Math.floor(seconds + 1e-9);
  const hundredths = Math.floor((seconds - whole + 1e-9) * 100);
  const minutes = Math.floor(whole / 60);
  return `${minutes}:${String(whole % 60).padStart(2, '0')}.${String(Math.max(hundredths, 0)).padStart(2, '0')}`;
}

export function plural(count: number, one: string, many = `${one}s`): string {
  return `${count.toLocaleString('en')} ${count === 1 ? one : many}`;
}

const SPELLED: Readonly<Record<string, string>> = { bvh: 'BVH', kd_tree: 'k-d tree', bsp_tree: 'BSP tree', semi_implicit_euler: 'Semi-implicit Euler' };

// soft_step -> Soft step
export function words(name: string): string {
  const text = SPELLED[name] ?? name.replaceAll('_', ' ');
  return text.charAt(0).toUpperCase() + text.slice(1);
}
