// Bytes of the finest level of models in other formats, as rows of the table in docs/delivery.md: Draco, gltfpack, and the JSON
// of thesis B. The models are binary glTF files that `cargo bench --bench package -- --glb FOLDER` writes: quantized values, one
// level, no clips, materials and images. Tangents are left out, because gltfpack writes none.
//
//   npm install --prefix target/others draco3d@1.5.9 gltfpack@1.3.0
//   cargo bench --no-default-features --bench package -- --glb target/others FILES
//   node benches/package/others.mjs target/others
//
// Settings: Draco with edgebreaker at speed 0; gltfpack -cc -kv. Positions have as many bits as the package's grid has in the
// model's extent, at most 16; texture coordinates 14, normals 10; weights 14 in Draco, 8 in gltfpack, which has no setting.
import { execFileSync } from "node:child_process";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { gzipSync } from "node:zlib";

const folder = resolve(process.argv[2] ?? "target/others");
const require = createRequire(join(folder, "package.json"));
const draco = await require("draco3d").createEncoderModule({});
const gltfpack = join(folder, "node_modules", "gltfpack", "cli.js");

const ARRAYS = { 5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
const [NORMAL_BITS, UV_BITS, WEIGHT_BITS] = [10, 14, 14];

// The JSON and the binary chunk of a GLB file.
function parse(glb) {
    const length = glb.readUInt32LE(12);
    const json = JSON.parse(glb.subarray(20, 20 + length).toString());
    return { json, binary: glb.subarray(28 + length) };
}

function glb(json, binary) {
    const text = Buffer.from(JSON.stringify(json));
    const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, 32)]);
    const word = (...values) => Buffer.from(Uint32Array.from(values).buffer);
    const size = 28 + padded.length + binary.length;
    const json_chunk = [word(padded.length, 0x4e4f534a), padded];
    return Buffer.concat([word(0x46546c67, 2, size), ...json_chunk, word(binary.length, 0x004e4942), binary]);
}

// The values of an accessor, packed.
function values({ json, binary }, index) {
    const accessor = json.accessors[index];
    const [Type, width] = [ARRAYS[accessor.componentType], WIDTHS[accessor.type]];
    const view = json.bufferViews[accessor.bufferView];
    const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const stride = view.byteStride ?? width * Type.BYTES_PER_ELEMENT;
    const packed = new Type(width * accessor.count);
    for (let at = 0; at < accessor.count; at++) {
        const bytes = binary.subarray(start + at * stride, start + at * stride + width * Type.BYTES_PER_ELEMENT);
        packed.set(new Type(Uint8Array.from(bytes).buffer), width * at);
    }
    return { packed, width, count: accessor.count };
}

// Bits of positions: the smallest number that is no coarser than the grid of the values.
function positionBits(primitives) {
    let [step, extent] = [1, 0];
    const all = primitives.map((primitive) => primitive.POSITION.packed);
    const onGrid = () => all.every((packed) => packed.every((value) => Number.isInteger(value / step)));
    while (!onGrid() && step > 2 ** -40) step /= 2;
    for (let axis = 0; axis < 3; axis++) {
        let [low, high] = [Infinity, -Infinity];
        for (const packed of all) {
            for (let at = axis; at < packed.length; at += 3) {
                [low, high] = [Math.min(low, packed[at]), Math.max(high, packed[at])];
            }
        }
        extent = Math.max(extent, high - low);
    }
    return Math.min(16, Math.ceil(Math.log2(extent / step + 1)));
}

function dracoBytes(primitive, bits) {
    const [encoder, builder, mesh] = [new draco.Encoder(), new draco.MeshBuilder(), new draco.Mesh()];
    builder.AddFacesToMesh(mesh, primitive.indices.length / 3, primitive.indices);
    for (const [name, { packed, width, count }] of Object.entries(primitive)) {
        if (name === "indices") continue;
        const type = { POSITION: draco.POSITION, NORMAL: draco.NORMAL, TEXCOORD_0: draco.TEX_COORD }[name] ?? draco.GENERIC;
        const add = { Float32Array: "AddFloatAttribute", Uint8Array: "AddUInt8Attribute", Uint16Array: "AddUInt16Attribute" };
        builder[add[packed.constructor.name]](mesh, type, count, width, packed);
    }
    encoder.SetSpeedOptions(0, 0);
    encoder.SetEncodingMethod(draco.MESH_EDGEBREAKER_ENCODING);
    const quantization = [[draco.POSITION, bits], [draco.NORMAL, NORMAL_BITS], [draco.TEX_COORD, UV_BITS], [draco.GENERIC, WEIGHT_BITS]];
    quantization.forEach(([type, bits]) => encoder.SetAttributeQuantization(type, bits));
    const bytes = new draco.DracoInt8Array();
    const length = encoder.EncodeMeshToDracoBuffer(mesh, bytes);
    if (length <= 0) throw new Error("Draco refuses a mesh");
    [bytes, mesh, builder, encoder].forEach((object) => draco.destroy(object));
    return length;
}

// The shortest decimal number with the same bits as a float.
function short(value) {
    for (let digits = 1; digits < 9; digits++) {
        const number = Number(value.toPrecision(digits));
        if (Math.fround(number) === value) return number;
    }
    return Number(value.toPrecision(9));
}

console.log("| model | Draco, bytes | gltfpack, bytes | gltfpack and gzip, bytes | JSON, bytes | JSON and gzip, bytes |");
console.log(`|${"---|".repeat(6)}`);
for (const name of readdirSync(folder).filter((file) => file.endsWith(".finest.glb")).sort()) {
    const file = parse(readFileSync(join(folder, name)));
    const all = file.json.meshes.flatMap((mesh) => mesh.primitives);
    all.forEach((primitive) => delete primitive.attributes.TANGENT);
    const primitives = all.map((primitive) => {
        const attributes = Object.entries(primitive.attributes).map(([name, index]) => [name, values(file, index)]);
        return { indices: Uint32Array.from(values(file, primitive.indices).packed), ...Object.fromEntries(attributes) };
    });
    const bits = positionBits(primitives);
    const ofDraco = primitives.reduce((sum, primitive) => sum + dracoBytes(primitive, bits), 0);

    const [bare, packed] = ["bare.glb", "packed.glb"].map((name) => join(folder, name));
    writeFileSync(bare, glb(file.json, file.binary));
    const settings = ["-cc", "-kv", "-vp", `${bits}`, "-vt", `${UV_BITS}`, "-vn", `${NORMAL_BITS}`];
    execFileSync(process.execPath, [gltfpack, "-i", bare, "-o", packed, ...settings], { stdio: "ignore" });
    const { json, binary } = parse(readFileSync(packed));
    const views = json.bufferViews.map((view) => view.extensions?.EXT_meshopt_compression).filter(Boolean);
    const chunks = views.map((view) => binary.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength));
    const ofGltfpack = Buffer.concat(chunks);

    const flat = (name) => primitives.flatMap((primitive) => Array.from(primitive[name]?.packed ?? [], short));
    let first = 0;
    const indices = primitives.flatMap((primitive) => {
        const own = Array.from(primitive.indices, (index) => index + first);
        first += primitive.POSITION.count;
        return own;
    });
    const text = JSON.stringify({
        vertexPositions: flat("POSITION"),
        vertexNormals: flat("NORMAL"),
        vertexTextureCoords: flat("TEXCOORD_0"),
        indices,
    });
    const [zipped, ofText] = [gzipSync(ofGltfpack, { level: 9 }), gzipSync(text, { level: 9 })];
    const row = [name.replace(".finest.glb", ""), ofDraco, ofGltfpack.length, zipped.length, text.length, ofText.length];
    console.log(`| ${row.join(" | ")} |`);
}
