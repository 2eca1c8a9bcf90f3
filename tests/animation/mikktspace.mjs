// Makes mikktspace.json: a bumpy grid whose texture is mirrored in the middle, and its tangents, by the reference
// implementation compiled to WebAssembly, as three.js takes it:
//   npm install mikktspace@1.1.1 && node mikktspace.mjs > mikktspace.json
import { createRequire } from "node:module";
const { generateTangents } = createRequire(process.cwd() + "/")("mikktspace");

let state = 7;
const random = () => {
  state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
  return state / 2 ** 32;
};
const single = (values) => Array.from(new Float32Array(values));
const EDGE = 6;
const positions = [], normals = [], uv = [], indices = [];
for (let row = 0; row < EDGE; row++) {
  for (let column = 0; column < EDGE; column++) {
    positions.push(single([column + 0.3 * random(), row + 0.3 * random(), random()]));
    const [x, y, z] = [random() - 0.5, random() - 0.5, 1];
    const length = Math.hypot(x, y, z);
    normals.push(single([x / length, y / length, z / length]));
    // Columns 0 to 2 run up, 2 to 5 back.
    const along = column < 3 ? column : 4 - column;
    uv.push(single([0.1 * along + 0.02 * random(), 0.15 * row + 0.05 * along]));
  }
}
for (let row = 0; row + 1 < EDGE; row++) {
  for (let column = 0; column + 1 < EDGE; column++) {
    const at = EDGE * row + column;
    indices.push(at, at + 1, at + EDGE, at + 1, at + EDGE + 1, at + EDGE);
  }
}
const corners = (list) => new Float32Array(indices.flatMap((vertex) => list[vertex]));
const found = generateTangents(corners(positions), corners(normals), corners(uv));
const tangents = indices.map((_, at) => Array.from(found.slice(4 * at, 4 * at + 4)));
console.log(JSON.stringify({ positions, normals, uv, indices, tangents }).replaceAll("],[", "],\n["));
