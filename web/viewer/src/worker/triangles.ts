// Cooked geometry as triangles to draw.

// Every face of a hull is convex: a fan around its first corner.
export function fans(offsets: ArrayLike<number>, corners: ArrayLike<number>): Uint32Array {
  const out: number[] = [];
  for (let face = 0; face + 1 < offsets.length; face++) {
    const begin = offsets[face]!;
    for (let i = begin + 1; i + 1 < offsets[face + 1]!; i++) out.push(corners[begin]!, corners[i]!, corners[i + 1]!);
  }
  return Uint32Array.from(out);
}

// Two triangles a cell, none where a corner is a hole; the diagonal runs as the engine's does.
export function grid(heights: ArrayLike<number>, columns: number, rows: number, spacing: number): { vertices: Float32Array; indices: Uint32Array } {
  const vertices = new Float32Array(3 * columns * rows);
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      const at = row * columns + column;
      const height = heights[at]!;
      vertices.set([(column - (columns - 1) / 2) * spacing, Number.isNaN(height) ? 0 : height, (row - (rows - 1) / 2) * spacing], 3 * at);
    }
  }
  const indices: number[] = [];
  for (let row = 0; row + 1 < rows; row++) {
    for (let column = 0; column + 1 < columns; column++) {
      const a = row * columns + column;
      const b = a + 1;
      const c = a + columns;
      const d = c + 1;
      if ([a, b, c, d].some((corner) => Number.isNaN(heights[corner]))) continue;
      indices.push(a, c, b, b, c, d);
    }
  }
  return { vertices, indices: Uint32Array.from(indices) };
}
