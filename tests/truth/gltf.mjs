// Writes glTF 2.0: a document and its buffer, to which accessors and nodes are added one after another.

export const [I8, U8, I16, U16, U32, F32] = [5120, 5121, 5122, 5123, 5125, 5126];
const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
// The integers that stand for 1 where a component type is normalized.
const ONES = { 5120: 127, 5121: 255, 5122: 32767, 5123: 65535 };

// The nearest quaternion of normalized integers whose length is exactly 1.
export function exact(quaternion, component) {
    const one = ONES[component];
    const near = quaternion.slice(0, 3).map((value) => Math.round(value * one));
    const steps = Array.from({ length: 121 }, (_, at) => (at % 2 === 0 ? 1 : -1) * Math.ceil(at / 2));
    let [best, least] = [undefined, Infinity];
    for (const x of steps) for (const y of steps) for (const z of steps) {
        const three = near.map((value, axis) => value + [x, y, z][axis]);
        const left = three.reduce((sum, value) => sum - value * value, one * one);
        const w = Math.round(Math.sqrt(Math.max(left, 0)));
        if (w * w === left && x * x + y * y + z * z < least) {
            [best, least] = [[...three, quaternion[3] < 0 ? -w : w], x * x + y * y + z * z];
        }
    }
    return best.map((value) => value / one);
}

// Encodes numbers as bytes of a component type; the numbers are fractions where the type is normalized.
function packed(values, component, normalized) {
    const one = ONES[component];
    return ARRAYS[component].from(normalized ? values.map((value) => Math.round(value * one)) : values);
}

export class Gltf {
    constructor() {
        this.json = {
            asset: { version: "2.0", generator: "relievo tests/truth" },
            scene: 0,
            scenes: [{ nodes: [] }],
        };
        this.bytes = [];
    }

    push(list, value) {
        this.json[list] ??= [];
        return this.json[list].push(value) - 1;
    }

    // Adds a buffer view, whose offset is a multiple of 4.
    view(array, more = {}) {
        while (this.bytes.length % 4 !== 0) this.bytes.push(0);
        const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
        const byteOffset = this.bytes.length;
        for (const byte of bytes) this.bytes.push(byte);
        return this.push("bufferViews", { buffer: 0, byteOffset, byteLength: bytes.length, ...more });
    }

    // Adds an accessor with a buffer view of its own. `sparse` is a list of [index, values] that replace some of the
    // values, or of `count` zeros.
    accessor(type, values, { component = F32, normalized = false, sparse, bounds = false, count } = {}) {
        const width = WIDTHS[type];
        const array = packed(values ?? new Array(count * width).fill(0), component, normalized);
        const accessor = { componentType: component, type, count: array.length / width };
        if (values) accessor.bufferView = this.view(array);
        if (normalized) accessor.normalized = true;
        if (sparse) {
            const indices = Uint16Array.from(sparse.map(([index]) => index));
            const replaced = packed(sparse.flatMap(([, replaced]) => replaced), component, normalized);
            accessor.sparse = {
                count: indices.length,
                indices: { bufferView: this.view(indices), componentType: U16 },
                values: { bufferView: this.view(replaced) },
            };
            sparse.forEach(([index], at) => array.set(replaced.slice(at * width, (at + 1) * width), index * width));
        }
        if (bounds) Object.assign(accessor, extent(array, width));
        return this.push("accessors", accessor);
    }

    // Adds interleaved attributes, each padded to a multiple of 4 bytes.
    interleaved(attributes) {
        const columns = attributes.map(({ type, values, component = F32, normalized = false, bounds }) => {
            const [array, width] = [packed(values, component, normalized), WIDTHS[type]];
            return { type, array, width, component, normalized, bounds, count: array.length / width };
        });
        const sizes = columns.map(({ array, width }) => Math.ceil((width * array.BYTES_PER_ELEMENT) / 4) * 4);
        const byteStride = sizes.reduce((sum, size) => sum + size, 0);
        const bytes = new Uint8Array(byteStride * columns[0].count);
        let first = 0;
        const offsets = columns.map(({ array, width, count }, at) => {
            const raw = new Uint8Array(array.buffer);
            const size = width * array.BYTES_PER_ELEMENT;
            for (let vertex = 0; vertex < count; vertex++) {
                bytes.set(raw.slice(vertex * size, (vertex + 1) * size), vertex * byteStride + first);
            }
            first += sizes[at];
            return first - sizes[at];
        });
        const bufferView = this.view(bytes, { byteStride, target: 34962 });
        return columns.map(({ type, array, width, component, normalized, bounds, count }, at) => {
            const accessor = { bufferView, byteOffset: offsets[at], componentType: component, type, count };
            if (normalized) accessor.normalized = true;
            if (bounds) Object.assign(accessor, extent(array, width));
            return this.push("accessors", accessor);
        });
    }

    // Adds a node below another one or, by default, to the default scene; with `null` to neither.
    node(parent, fields) {
        const node = this.push("nodes", fields);
        if (parent === undefined) this.json.scenes[this.json.scene].nodes.push(node);
        else if (parent !== null) (this.json.nodes[parent].children ??= []).push(node);
        return node;
    }

    // Adds a shape as a primitive: positions, normals, indices, and its joints and weights if it has them.
    primitive({ positions, normals, indices, joints, weights }, more = {}) {
        const attributes = { POSITION: this.accessor("VEC3", positions, { bounds: true }) };
        if (normals) attributes.NORMAL = this.accessor("VEC3", normals);
        if (joints) attributes.JOINTS_0 = this.accessor("VEC4", joints, { component: U8 });
        if (weights) attributes.WEIGHTS_0 = this.accessor("VEC4", weights);
        return { attributes, indices: this.accessor("SCALAR", indices, { component: U16 }), ...more };
    }

    mesh(...primitives) {
        return this.push("meshes", { primitives });
    }

    skin(joints, inverseBinds) {
        return this.push("skins", { joints, inverseBindMatrices: this.accessor("MAT4", inverseBinds.flat()) });
    }

    // Adds an animation; a channel is [node, path, times, values, interpolation and storage].
    clip(name, channels) {
        const samplers = channels.map(([, path, times, values, { interpolation = "LINEAR", ...stored } = {}]) => {
            const type = { rotation: "VEC4", weights: "SCALAR" }[path] ?? "VEC3";
            return {
                input: this.accessor("SCALAR", times, { bounds: true }),
                output: this.accessor(type, values.flat(), stored),
                interpolation,
            };
        });
        const targets = channels.map(([node, path], sampler) => ({ sampler, target: { node, path } }));
        return this.push("animations", { name, samplers, channels: targets });
    }

    // Writes the JSON, and the buffer to a file of the given name.
    gltf(uri) {
        return JSON.stringify({ ...this.json, buffers: [{ uri, byteLength: this.bytes.length }] });
    }

    // Writes header, JSON and buffer to one GLB file.
    glb() {
        const text = Buffer.from(JSON.stringify({ ...this.json, buffers: [{ byteLength: this.bytes.length }] }));
        const chunks = [
            [0x4e4f534a, text, 0x20],
            [0x004e4942, Buffer.from(this.bytes), 0],
        ].map(([kind, data, fill]) => {
            const filled = Buffer.alloc(Math.ceil(data.length / 4) * 4, fill);
            data.copy(filled);
            return Buffer.concat([words(filled.length, kind), filled]);
        });
        const length = chunks.reduce((sum, chunk) => sum + chunk.length, 12);
        return Buffer.concat([words(0x46546c67, 2, length), ...chunks]);
    }
}

function words(...values) {
    return Buffer.from(Uint32Array.from(values).buffer);
}

function extent(array, width) {
    const column = (axis) => Array.from(array).filter((_, at) => at % width === axis);
    const axes = Array.from({ length: width }, (_, axis) => column(axis));
    return { min: axes.map((all) => Math.min(...all)), max: axes.map((all) => Math.max(...all)) };
}
