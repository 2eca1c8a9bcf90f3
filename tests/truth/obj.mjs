// node obj.mjs            writes what three.js reads from files/shapes.obj to files/shapes.json
// node obj.mjs OBJ GLB    checks two folders that `relievo simplify --format obj` and `--format glb` wrote: three.js must read every
//                         level with the triangles of the report, and in the same places from both

import { readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { Box3, REVISION, Vector3 } from "three";
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";
import { load } from "./judge.mjs";

async function parsed(path) {
    return new OBJLoader().parse(await readFile(path, "utf8"));
}

// The triangles of every object and material: position, texture coordinates and normal of each corner.
function parts(root) {
    const found = [];
    for (const { name, material, geometry } of root.children) {
        const { position, normal, uv } = geometry.attributes;
        const materials = Array.isArray(material) ? material : [material];
        const groups = geometry.groups.length ? geometry.groups : [{ start: 0, count: position.count, materialIndex: 0 }];
        for (const { start, count, materialIndex } of groups) {
            const corners = [];
            for (let at = start; at < start + count; ++at) {
                const of = (attribute, size) => [0, 1, 2].slice(0, size).map((axis) => attribute.getComponent(at, axis));
                corners.push([...of(position, 3), ...of(uv, 2), ...of(normal, 3)]);
            }
            found.push({ name, material: materials[materialIndex].name, corners });
        }
    }
    return found;
}

function measured(root) {
    const box = new Box3();
    let triangles = 0;
    root.updateMatrixWorld(true);
    root.traverse((object) => {
        if (!object.isMesh) return;
        const { index, attributes } = object.geometry;
        triangles += (index ?? attributes.position).count / 3;
        // Corners that no triangle uses do not count.
        const corner = new Vector3();
        for (let at = 0; at < (index ?? attributes.position).count; ++at) {
            corner.fromBufferAttribute(attributes.position, index ? index.getX(at) : at);
            box.expandByPoint(corner.applyMatrix4(object.matrixWorld));
        }
    });
    return { triangles, bounds: [...box.min.toArray(), ...box.max.toArray()] };
}

const [obj, glb] = process.argv.slice(2);
if (obj) {
    const report = JSON.parse(await readFile(join(obj, "report.json"), "utf8"));
    for (const [at, level] of report.levels.entries()) {
        const [a, b] = [measured(await parsed(join(obj, level.file))), measured((await load(join(glb, `level_${at}.glb`))).scene)];
        const off = Math.max(...a.bounds.map((bound, axis) => Math.abs(bound - b.bounds[axis])));
        console.log(`${level.file}: ${a.triangles} and ${b.triangles} of ${level.triangles} triangles, bounds ${off} apart`);
        if (a.triangles !== level.triangles || b.triangles !== level.triangles || !(off === 0)) process.exitCode = 1;
    }
} else {
    const files = join(dirname(fileURLToPath(import.meta.url)), "files");
    const lines = parts(await parsed(join(files, "shapes.obj"))).map((part) => `  ${JSON.stringify(part)}`);
    await writeFile(join(files, "shapes.json"), `{"three": "${REVISION}", "parts": [\n${lines.join(",\n")}\n]}\n`);
}
