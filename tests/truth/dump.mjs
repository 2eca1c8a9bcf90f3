// node dump.mjs DUMP SCENES [PIXELS]   checks the dump of `relievo scene --dump --out DUMP` with three.js: where the vertices
//                                      of its characters are drawn, and where three.js poses them at the same time
//
// SCENES is the folder of the scene file, to which the files of characters are relative. Each vertex is skinned twice, by the
// bones of the dump and by those of three.js, and projected by the frame's camera. Exits with 1 if one of a drawn instance,
// inside the picture, is more than PIXELS apart; by default 0.01, which is for dumps of `--full`. Vertices at the picture's very
// edge, of which one place lies inside and one outside, are counted apart. Bones alone are
// compared: levels of detail of meshes and of influences are not in a dump.

import { readFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import { AnimationMixer, LoopOnce, Matrix4, Quaternion, Vector3, Vector4 } from "three";
import { Apart } from "./apart.mjs";
import { load } from "./judge.mjs";

const CELL = 256;
const MOST = 2000; // vertices of a mesh

const [folder, scenes, limit = "0.01"] = process.argv.slice(2);
const { characters, frames } = JSON.parse(await readFile(join(folder, "characters.json")));
const bytes = await readFile(join(folder, "characters.f32"));
const numbers = new Float32Array(Uint8Array.from(bytes).buffer);

// A file, with its objects by their names in the dump.
async function opened({ file, bones }) {
    if (file.startsWith("builtin:")) return null;
    const gltf = await load(resolve(scenes, file));
    const nodes = await Promise.all((gltf.parser.json.nodes ?? []).map((_, node) => gltf.parser.getDependency("node", node)));
    const names = nodes.map((_, node) => gltf.parser.json.nodes[node].name ?? `node_${node}`);
    const order = bones.map((name) => nodes[names.indexOf(name)]);
    const meshes = [];
    gltf.scene.traverse((object) => object.isSkinnedMesh && meshes.push(object));
    return { gltf, order, meshes };
}

function posed({ gltf }, clip, seconds) {
    const mixer = new AnimationMixer(gltf.scene);
    const action = mixer.clipAction(gltf.animations[clip]).setLoop(LoopOnce, 1);
    action.clampWhenFinished = true;
    action.play();
    mixer.setTime(seconds);
    gltf.scene.updateMatrixWorld(true);
    return () => mixer.stopAllAction();
}

// The sum of a vertex under its bones, whose matrices `of` gives.
function skinned(mesh, vertex, of) {
    const { position, skinIndex, skinWeight } = mesh.geometry.attributes;
    const bind = new Vector4(...new Vector3().fromBufferAttribute(position, vertex).applyMatrix4(mesh.bindMatrix), 1);
    const sum = new Vector4(0, 0, 0, 0);
    for (let slot = 0; slot < 4; slot++) {
        const [joint, weight] = [skinIndex.getComponent(vertex, slot), skinWeight.getComponent(vertex, slot)];
        if (weight === 0) continue;
        const product = new Matrix4().multiplyMatrices(of(mesh.skeleton.bones[joint]), mesh.skeleton.boneInverses[joint]);
        sum.addScaledVector(bind.clone().applyMatrix4(product), weight);
    }
    return sum;
}

const files = await Promise.all(characters.map(opened));
const apart = new Apart();
let [first, skipped] = [0, 0];
for (const { camera, instances } of frames) {
    for (const { character, drawn, cell, at, turn, scale, clip, clip_seconds } of instances) {
        const { bones } = characters[character];
        const own = numbers.subarray(first, first + 12 * bones.length);
        first += 12 * bones.length;
        const file = files[character];
        if (!drawn || !file) {
            skipped += 1;
            continue;
        }
        // Everything is taken relative to the camera's cell.
        const corner = camera.cell.map((index) => index * CELL);
        const place = at.map((value, axis) => value + cell[axis] * CELL - corner[axis]);
        const world = new Matrix4().compose(new Vector3(...place), new Quaternion(...turn), new Vector3(...scale));
        const stop = posed(file, clip, clip_seconds);
        const dumped = new Map(file.order.map((bone, index) => {
            const rows = Array.from(own.subarray(12 * index, 12 * index + 12));
            [3, 7, 11].forEach((entry, axis) => (rows[entry] -= corner[axis]));
            return [bone, new Matrix4().set(...rows, 0, 0, 0, 1)];
        }));
        for (const mesh of file.meshes) {
            const count = mesh.geometry.attributes.position.count;
            for (let vertex = 0; vertex < count; vertex += Math.ceil(count / MOST)) {
                const right = skinned(mesh, vertex, (bone) => new Matrix4().multiplyMatrices(world, bone.matrixWorld));
                const found = skinned(mesh, vertex, (bone) => dumped.get(bone));
                apart.add(camera, right, found);
            }
        }
        stop();
    }
}
if (first !== numbers.length) throw new Error(`characters.f32 has ${numbers.length} numbers, not ${first}`);
console.log(`${frames.length} frames, ${apart}; ${skipped} instances skipped`);
process.exit(apart.holds(Number(limit)) ? 0 : 1);
