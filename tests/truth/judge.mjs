// Computes with three.js where the nodes, vertices and normals of a file are at moments of its clips.

import { readFile } from "node:fs/promises";
import { dirname } from "node:path";
import { pathToFileURL } from "node:url";
import { AnimationMixer, FileLoader, LoopOnce, Matrix3, Matrix4, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

// Node.js lacks a browser's loaders: this reads buffers beside a document from disk, and reads no images.
FileLoader.prototype.load = function (url, onLoad, _onProgress, onError) {
    const there = new URL(url, this.path || undefined);
    const read = there.protocol === "file:" ? readFile(there) : fetch(there).then((data) => data.arrayBuffer());
    read.then((bytes) => onLoad(bytes instanceof ArrayBuffer ? bytes : Uint8Array.from(bytes).buffer), onError);
};

// Textures need a browser and do not move vertices, so they are left out.
function withoutImages(bytes) {
    const isBinary = bytes.toString("latin1", 0, 4) === "glTF";
    const length = isBinary ? bytes.readUInt32LE(12) : bytes.length;
    const json = JSON.parse(bytes.toString("utf8", isBinary ? 20 : 0, (isBinary ? 20 : 0) + length));
    delete json.materials;
    delete json.textures;
    delete json.images;
    for (const primitive of (json.meshes ?? []).flatMap((mesh) => mesh.primitives)) delete primitive.material;
    const text = Buffer.from(JSON.stringify(json));
    if (!isBinary) return text;
    const padded = Buffer.alloc(Math.ceil(text.length / 4) * 4, 0x20);
    text.copy(padded);
    const whole = Buffer.concat([bytes.subarray(0, 20), padded, bytes.subarray(20 + length)]);
    whole.writeUInt32LE(whole.length, 8);
    whole.writeUInt32LE(padded.length, 12);
    return whole;
}

export async function load(path) {
    const bytes = withoutImages(await readFile(path));
    const folder = `${pathToFileURL(dirname(path)).href}/`;
    const data = Uint8Array.from(bytes).buffer;
    return new GLTFLoader().parseAsync(data, folder);
}

// The nodes of the default scene and their primitives, by the names that the importer gives them.
async function contents({ scene, parser }) {
    const all = await Promise.all((parser.json.nodes ?? []).map((_, node) => parser.getDependency("node", node)));
    const isShown = (object) => object !== null && (object === scene || isShown(object.parent));
    const isNode = (object) => all.includes(object) || all.some(({ name }) => name !== "" && name === object.name);
    const [nodes, meshes] = [[], []];
    for (const [node, own] of all.entries()) {
        // If several scenes share a node, three.js gives each scene after the first a copy with the same name.
        const object = isShown(own) ? own : own.name && scene.getObjectByName(own.name);
        if (!object) continue;
        const name = parser.json.nodes[node].name ?? `node_${node}`;
        nodes.push({ name, object });
        // three.js makes a group of a mesh with several primitives; the primitives precede the node's children.
        const primitives = object.isMesh ? [object] : object.children.filter((child) => child.isMesh && !isNode(child));
        primitives.forEach((object, primitive) => meshes.push({ name: `${name}_${primitive}`, object }));
    }
    return { nodes, meshes };
}

function positions(mesh) {
    const [all, place] = [[], new Vector3()];
    for (let vertex = 0; vertex < mesh.geometry.attributes.position.count; vertex++) {
        all.push(...mesh.getVertexPosition(vertex, place).applyMatrix4(mesh.matrixWorld));
    }
    return all;
}

// The matrix from a vertex to the scene, for normals: three.js computes normals in shaders only.
function matrixOf(mesh, vertex) {
    if (!mesh.isSkinnedMesh) return mesh.matrixWorld;
    const { skinIndex, skinWeight } = mesh.geometry.attributes;
    const { bones, boneInverses } = mesh.skeleton;
    const [sum, product] = [new Matrix4(), new Matrix4()];
    sum.elements.fill(0);
    for (let slot = 0; slot < 4; slot++) {
        const [joint, weight] = [skinIndex.getComponent(vertex, slot), skinWeight.getComponent(vertex, slot)];
        product.multiplyMatrices(bones[joint].matrixWorld, boneInverses[joint]);
        sum.elements.forEach((value, at) => (sum.elements[at] = value + weight * product.elements[at]));
    }
    return sum;
}

function normals(mesh) {
    const [all, normal, matrix] = [[], new Vector3(), new Matrix3()];
    const given = mesh.geometry.attributes.normal;
    for (let vertex = 0; vertex < given.count; vertex++) {
        matrix.getNormalMatrix(matrixOf(mesh, vertex));
        all.push(...normal.fromBufferAttribute(given, vertex).applyMatrix3(matrix).normalize());
    }
    return all;
}

// About `most` moments: at keys, between keys, before the first key and after the last.
function moments(clip, most) {
    const keys = [...new Set(clip.tracks.flatMap((track) => Array.from(track.times)))].sort((a, b) => a - b);
    const some = keys.filter((_, at) => at % Math.ceil(keys.length / most) === 0 || at === keys.length - 1);
    const between = some.slice(1).map((key, at) => Math.fround(some[at] + 0.37 * (key - some[at])));
    const times = [0, ...some, ...between, Math.fround(clip.duration + 0.5)];
    return [...new Set(times)].sort((a, b) => a - b);
}

// The numbers of a pose: three rows of four for each node, then for each mesh its positions and, if it has them, its
// normals.
function numbers({ nodes, meshes }) {
    const rows = ({ object: { matrixWorld: { elements } } }) =>
         [0, 1, 2].flatMap((row) => [0, 4, 8, 12].map((column) => elements[row + column]));
    return [
        ...nodes.flatMap(rows),
        ...meshes.flatMap(({ object }) => [...positions(object), ...(hasNormals(object) ? normals(object) : [])]),
    ];
}

// Morph targets also change normals, which three.js does in shaders only; such normals are left out.
function hasNormals({ geometry }) {
    return geometry.attributes.normal !== undefined && geometry.morphAttributes.position === undefined;
}

// Lists nodes and meshes, and appends the numbers of each moment.
export async function judged(path) {
    const gltf = await load(path);
    const all = await contents(gltf);
    const described = all.meshes.map(({ name, object }) => ({
        name, vertices: object.geometry.attributes.position.count, normals: hasNormals(object),
    }));
    const poses = [];
    // Larger models get fewer moments, so that the file stays small.
    const most = Math.max(2, Math.min(Math.floor(3500 / numbers(all).length), 8));
    const pose = (clip, time) => {
        gltf.scene.updateMatrixWorld(true);
        poses.push({ clip, time, numbers: numbers(all) });
    };
    pose(null, 0);
    for (const [index, clip] of gltf.animations.entries()) {
        for (const time of moments(clip, most)) {
            // Nodes that the clip does not move return to rest.
            const mixer = new AnimationMixer(gltf.scene);
            const action = mixer.clipAction(clip).setLoop(LoopOnce, 1);
            action.clampWhenFinished = true;
            action.play();
            mixer.setTime(time);
            pose(index, time);
            mixer.stopAllAction();
        }
    }
    return { nodes: all.nodes.map(({ name }) => name), meshes: described, poses };
}
