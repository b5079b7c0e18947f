// Principal moments and axes of an inertia tensor: Jacobi's rotations, C. Jacobi, "Ueber ein leichtes Verfahren", 1846.
import { Matrix4 } from 'three';

export interface PrincipalAxes {
  moments: [number, number, number];
  axes: Matrix4; // columns: the axes, right-handed
}

// xx, yy, zz, xy, xz, yz
export function principalAxes([xx, yy, zz, xy, xz, yz]: readonly number[] & { length: 6 }): PrincipalAxes {
  const a = [
    [xx!, xy!, xz!],
    [xy!, yy!, yz!],
    [xz!, yz!, zz!],
  ];
  const v = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ];
  for (let sweep = 0; sweep < 12; sweep++) {
    for (const [p, q] of [
      [0, 1],
      [0, 2],
      [1, 2],
    ] as const) {
      if (Math.abs(a[p]![q]!) < 1e-12 * (Math.abs(a[p]![p]!) + Math.abs(a[q]![q]!))) continue;
      const theta = (a[q]![q]! - a[p]![p]!) / (2 * a[p]![q]!);
      const t = Math.sign(theta || 1) / (Math.abs(theta) + Math.hypot(theta, 1));
      const c = 1 / Math.hypot(t, 1);
      const s = t * c;
      for (let k = 0; k < 3; k++) [a[k]![p], a[k]![q]] = [c * a[k]![p]! - s * a[k]![q]!, s * a[k]![p]! + c * a[k]![q]!];
      for (let k = 0; k < 3; k++) [a[p]![k], a[q]![k]] = [c * a[p]![k]! - s * a[q]![k]!, s * a[p]![k]! + c * a[q]![k]!];
      for (let k = 0; k < 3; k++) [v[k]![p], v[k]![q]] = [c * v[k]![p]! - s * v[k]![q]!, s * v[k]![p]! + c * v[k]![q]!];
    }
  }
  const m = new Matrix4().set(
    v[0]![0]!, v[0]![1]!, v[0]![2]!, 0,
    v[1]![0]!, v[1]![1]!, v[1]![2]!, 0,
    v[2]![0]!, v[2]![1]!, v[2]![2]!, 0,
    0, 0, 0, 1,
  );
  return { moments: [a[0]![0]!, a[1]![1]!, a[2]![2]!], axes: m };
}
