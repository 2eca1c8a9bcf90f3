// node make.mjs             writes the files of this folder, and the numbers that three.js computes from them
// node make.mjs OUT FILE…   writes the numbers that three.js computes from other files, and copies of the files, to OUT;
//                           buffers (.bin) are only copied

import { copyFile, mkdir, writeFile } from "node:fs/promises";
import { basename, dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { REVISION } from "three";
import { files } from "./files.mjs";
import { judged } from "./judge.mjs";

function documents(names) {
    return names.filter((name) => !name.endsWith(".bin"));
}

async function judge(folder, names) {
    const [index, all] = [[], []];
    for (const name of names) {
        const { poses, ...rest } = await judged(join(folder, name));
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
    await judge(folder, documents(Object.keys(written)));
}
