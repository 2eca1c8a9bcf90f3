// Compresses files with Google's Draco and with meshoptimizer, by way of glTF Transform.

import { NodeIO } from "@gltf-transform/core";
import { EXTMeshoptCompression, KHRDracoMeshCompression, KHRMeshQuantization } from "@gltf-transform/extensions";
import { quantize, reorder } from "@gltf-transform/functions";
import draco from "draco3dgltf";
import { MeshoptDecoder, MeshoptEncoder } from "meshoptimizer";

const EXTENSIONS = [EXTMeshoptCompression, KHRDracoMeshCompression, KHRMeshQuantization];

// What decompresses and compresses.
async function transform() {
    await Promise.all([MeshoptDecoder.ready, MeshoptEncoder.ready]);
    return new NodeIO().registerExtensions(EXTENSIONS).registerDependencies({
        "draco3d.decoder": await draco.createDecoderModule(),
        "draco3d.encoder": await draco.createEncoderModule(),
        "meshopt.decoder": MeshoptDecoder,
        "meshopt.encoder": MeshoptEncoder,
    });
}

// Small files, of which all meshes are compressed: of each its name, its bytes, and the same decompressed.
export async function compressed(files) {
    const io = await transform();
    const pack = async (source, extension, options, ...steps) => {
        const document = await io.readBinary(files[source]);
        document.setLogger({ debug() {}, info() {}, warn() {}, error: console.error });
        await document.transform(...steps);
        document.createExtension(extension).setRequired(true).setEncoderOptions(options);
        const bytes = await io.writeBinary(document);
        const plain = await io.readBinary(bytes);
        for (const used of plain.getRoot().listExtensionsUsed()) {
            if (used.extensionName === extension.EXTENSION_NAME) used.dispose();
        }
        return { bytes, plain: await io.writeBinary(plain) };
    };
    const { EDGEBREAKER, SEQUENTIAL } = KHRDracoMeshCompression.EncoderMethod;
    const slow = { encodeSpeed: 0, decodeSpeed: 0 };
    const small = [reorder({ encoder: MeshoptEncoder, target: "size" }), quantize()];
    return {
        "draco.glb": await pack("rig.glb", KHRDracoMeshCompression, { method: EDGEBREAKER, ...slow }),
        "sequential.glb": await pack("bound.glb", KHRDracoMeshCompression, { method: SEQUENTIAL }),
        "meshopt.glb": await pack("keys.glb", EXTMeshoptCompression, {
            method: EXTMeshoptCompression.EncoderMethod.QUANTIZE,
        }, ...small),
    };
}
