// node make.mjs             writes the files of this folder, and the numbers that three.js computes from them; compressed
//                           files are decompressed by the programs that compressed them before three.js reads them
// node make.mjs OUT FILE…   writes the numbers that three.js computes from other files, and copies of the files, to OUT;
//                           buffers (.bin) are only copied

import { copyFile, mkdir, mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { REVISION } from "three";
import { compressed } from "./compressed.mjs";
import { files } from "./files.mjs";
import { judged } from "./judge.mjs";

function documents(names) {
    return names.filter((name) => !name.endsWith(".bin"));
}

// Judges files of a folder; of those that lie decompressed in `plain` it reads these.
async function judge(folder, names, plain = {}) {
    const [index, all] = [[], []];
    for (const name of names) {
        const { poses, ...rest } = await judged(plain[name] ?? join(folder, name));
        const listed = poses.map(({ clip, time, numbers }) => {
            const first = all.length;
            for (const number of numbers) all.push(number);
            return { clip, time, first };
        });
        index.push({ file: name, ...rest, poses: listed });
    }
    const lines = index.map((entry) => `  ${JSON.stringify(entry)}`).join(",\n");
    await writeFile(join(folder, "truth.json"), `{"three": "${REVISION}", "files": [\n${lines}\n]}\n`);
    await writeFile(join(folder, "truth.f32"), Buffer.from(Float32Array.from(all).buffer));
}

const [out, ...others] = process.argv.slice(2);
if (out) {
    await mkdir(out, { recursive: true });
    for (const other of others) await copyFile(other, join(out, basename(other)));
    await judge(out, documents(others.map((other) => basename(other))));
} else {
    const folder = join(dirname(fileURLToPath(import.meta.url)), "files");
    await mkdir(folder, { recursive: true });
    const written = files();
    for (const [name, data] of Object.entries(written)) await writeFile(join(folder, name), data);
    const packed = await compressed(written);
    const [plain, aside] = [{}, await mkdtemp(join(tmpdir(), "truth-"))];
    for (const [name, { bytes, plain: decompressed }] of Object.entries(packed)) {
        await writeFile(join(folder, name), bytes);
        plain[name] = join(aside, name);
        await writeFile(plain[name], decompressed);
    }
    await judge(folder, documents([...Object.keys(written), ...Object.keys(packed)]), plain);
    await rm(aside, { recursive: true });
}
