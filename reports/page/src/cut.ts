// Cut face of a body: the section of its cells by a plane across an axis, with the field on it.

/** Division of a cell into tetrahedra: the weights of the cell's nodes at each corner, and the indices of the
 * four corners of each tetrahedron. */
interface Pattern { weights: number[][]; tetrahedra: number[][] }

/** Number of pieces along an edge of a curved cell. */
const PIECES = 4;

// Division of a cube into six tetrahedra around its diagonal (Kuhn). The bits of a corner's number are its x,
// y and z, from the lowest bit.
const KUHN = [[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]];
const CORNERS = [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]];
const EDGES = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
// Division of a quadratic tetrahedron by its own nodes: one tetrahedron at each corner, and four around the
// line between the midpoints of two opposite edges.
const TEN = [[0, 4, 6, 7], [4, 1, 5, 8], [6, 5, 2, 9], [7, 8, 9, 3], [4, 9, 5, 6], [4, 9, 6, 7], [4, 9, 7, 8], [4, 9, 8, 5]];

/** Shape functions of a hexahedron with 8 or 20 nodes, at local coordinates in [-1, 1]. */
function hexahedron(nodes: number, at: number[]): number[] {
  const corner = (c: number[]) => c.reduce((product, x, k) => product * (1 + x * at[k]), 1 / 8);
  if (nodes === 8) return CORNERS.map(corner);
  const middle = ([a, b]: number[]) => [0, 1, 2].reduce((product, k) => {
    const x = (CORNERS[a][k] + CORNERS[b][k]) / 2;
    return product * (x ? 1 + x * at[k] : 1 - at[k] * at[k]);
  }, 1 / 4);
  return [...CORNERS.map((c) => corner(c) * (c.reduce((sum, x, k) => sum + x * at[k], 0) - 2)), ...EDGES.map(middle)];
}

/** Shape functions of a wedge with 6 or 15 nodes; x and y are in the unit triangle, and z is in [-1, 1]. */
function wedge(nodes: number, [x, y, z]: number[]): number[] {
  const l = [1 - x - y, x, y];
  const sides = [1 - z, 1 + z];
  if (nodes === 6) return sides.flatMap((side) => l.map((a) => (a * side) / 2));
  const bubble = 1 - z * z;
  return [
    ...sides.flatMap((side) => l.map((a) => (a * ((2 * a - 1) * side - bubble)) / 2)),
    ...sides.flatMap((side) => l.map((a, k) => 2 * a * l[(k + 1) % 3] * side)),
    ...l.map((a) => a * bubble),
  ];
}

function ofWedge(nodes: number): Pattern {
  const n = nodes === 6 ? 1 : PIECES;
  const out: Pattern = { weights: [], tetrahedra: [] };
  const at = new Map<string, number>();
  for (let k = 0; k <= n; k++)
    for (let j = 0; j <= n; j++)
      for (let i = 0; i <= n - j; i++) {
        at.set(`${i},${j},${k}`, out.weights.length);
        out.weights.push(wedge(nodes, [i / n, j / n, (2 * k) / n - 1]));
      }
  const triangles: number[][][] = [];
  for (let j = 0; j < n; j++)
    for (let i = 0; i < n - j; i++) {
      triangles.push([[i, j], [i + 1, j], [i, j + 1]]);
      if (i + j + 1 < n) triangles.push([[i + 1, j], [i, j + 1], [i + 1, j + 1]]);
    }
  // The small wedges list their corners in one order, so that neighbours divide their common quadrilateral
  // along the same diagonal.
  for (let k = 0; k < n; k++)
    for (const [a, b, c] of triangles) {
      const [low, high] = [k, k + 1].map((z) => [a, b, c].map(([i, j]) => at.get(`${i},${j},${z}`)!));
      out.tetrahedra.push([low[0], low[1], low[2], high[2]], [low[0], low[1], high[1], high[2]], [low[0], high[0], high[1], high[2]]);
    }
  return out;
}

function pattern(nodes: number): Pattern {
  if (nodes === 6 || nodes === 15) return ofWedge(nodes);
  if (nodes === 4 || nodes === 10) {
    const own = Array.from({ length: nodes }, (_, i) => Array.from({ length: nodes }, (_, k) => Number(i === k)));
    return { weights: own, tetrahedra: nodes === 4 ? [[0, 1, 2, 3]] : TEN };
  }
  const n = nodes === 8 ? 1 : PIECES;
  const out: Pattern = { weights: [], tetrahedra: [] };
  const place = (i: number, j: number, k: number) => (k * (n + 1) + j) * (n + 1) + i;
  for (let k = 0; k <= n; k++)
    for (let j = 0; j <= n; j++)
      for (let i = 0; i <= n; i++) {
        out.weights.push(hexahedron(nodes, [i, j, k].map((x) => (2 * x) / n - 1)));
        if (i < n && j < n && k < n)
          for (const four of KUHN) out.tetrahedra.push(four.map((c) => place(i + (c & 1), j + ((c >> 1) & 1), k + (c >> 2))));
      }
  return out;
}

const patterns = new Map<number, Pattern>();

/** Triangles of a cut face: x, y, z of each corner in turn, and the field at each corner. */
export interface Face { points: number[]; values: number[] }

/** Cut face at the coordinate `at` along an axis. `places` and `values` are the positions of the nodes and
 * the field at them; without a field, the values of the face are NaN. */
export function face(
  cells: { nodes: number; indices: Uint32Array }[], places: Float32Array, values: Float32Array | null, axis: number, at: number,
): Face {
  const out: Face = { points: [], values: [] };
  for (const { nodes, indices } of cells) {
    if (!patterns.has(nodes)) patterns.set(nodes, pattern(nodes));
    const { weights, tetrahedra } = patterns.get(nodes)!;
    for (let start = 0; start < indices.length; start += nodes) {
      let [low, high] = [Infinity, -Infinity];
      for (let k = 0; k < nodes; k++) {
        const x = places[3 * indices[start + k] + axis];
        [low, high] = [Math.min(low, x), Math.max(high, x)];
      }
      // A curved edge may extend slightly beyond its nodes.
      const beyond = nodes > 8 ? 0.15 * (high - low) : 0;
      if (at < low - beyond || at > high + beyond) continue;
      const corners = weights.map((row) => {
        const corner = [0, 0, 0, 0];
        row.forEach((w, k) => {
          const node = indices[start + k];
          if (w) for (let c = 0; c < 4; c++) corner[c] += w * (c < 3 ? places[3 * node + c] : values ? values[node] : NaN);
        });
        return corner;
      });
      for (const four of tetrahedra) tetrahedron(four.map((k) => corners[k]), axis, at, out);
    }
  }
  return out;
}

/** Adds the section of a tetrahedron by a plane: no, one or two triangles. */
function tetrahedron(corners: number[][], axis: number, at: number, out: Face) {
  const below = corners.filter((c) => c[axis] < at);
  const above = corners.filter((c) => c[axis] >= at);
  const between = (a: number[], b: number[]) => {
    const part = (at - a[axis]) / (b[axis] - a[axis]);
    return a.map((x, k) => x + part * (b[k] - x));
  };
  const triangle = (...all: number[][]) => {
    for (const [x, y, z, value] of all) { out.points.push(x, y, z); out.values.push(value); }
  };
  if (below.length === 2) {
    const [a, b, c, d] = [between(below[0], above[0]), between(below[0], above[1]), between(below[1], above[1]), between(below[1], above[0])];
    triangle(a, b, c);
    triangle(a, c, d);
  } else if (below.length === 1) triangle(...above.map((c) => between(below[0], c)));
  else if (below.length === 3) triangle(...below.map((c) => between(c, above[0])));
}
