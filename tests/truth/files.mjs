// Builds the files, each in the manner of some exporter. Names of joints and meshes are unique within a file.

import { Matrix4, Quaternion, Vector3 } from "three";
import { Gltf, exact, I16, I8, U8, U16, U32 } from "./gltf.mjs";
import { bare, box, follows, joined, limb, turn } from "./shapes.mjs";

const X = [1, 0, 0];
const Y = [0, 1, 0];
const Z = [0, 0, 1];

function local({ translation = [0, 0, 0], rotation = [0, 0, 0, 1], scale = [1, 1, 1], matrix }) {
    if (matrix) return new Matrix4().fromArray(matrix);
    return new Matrix4().compose(new Vector3(...translation), new Quaternion(...rotation), new Vector3(...scale));
}

// The matrix from a node's space to the scene's, or to the space of a node above it.
function world(gltf, node, top = -1) {
    const parent = gltf.json.nodes.findIndex(({ children }) => children?.includes(node));
    const own = local(gltf.json.nodes[node]);
    return parent < 0 || parent === top ? own : world(gltf, parent, top).multiply(own);
}

// The inverse bind matrices of joints at rest, in the space of a node above them, for a mesh whose matrix there is
// `mesh`.
function binds(gltf, joints, { top = -1, mesh = new Matrix4() } = {}) {
    return joints.map((joint) => world(gltf, joint, top).invert().multiply(mesh).toArray());
}

// A chain of joints, each `step` above the joint before it.
function chain(gltf, parent, names, step) {
    return names.map((name, at) => (parent = gltf.node(parent, { name, translation: at === 0 ? [0, 0, 0] : step })));
}

// All lengths are in hundredths and along +Z, and the root node scales and turns them, as converters from FBX write them.
function armature() {
    const gltf = new Gltf();
    const top = gltf.node(undefined, { name: "Armature", rotation: turn(X, -Math.PI / 2), scale: [100, 100, 100] });
    const joints = chain(gltf, top, ["Hips", "Spine", "Chest", "Head"], [0, 0, 0.005]);
    const upright = new Matrix4().makeRotationX(Math.PI / 2);
    const shape = limb({ to: 0.015, radius: 0.003, joints: [0, 1, 2, 3] });
    const skin = gltf.skin(joints, binds(gltf, joints, { top, mesh: upright }));
    gltf.node(top, { name: "Body", mesh: gltf.mesh(gltf.primitive(shape)), skin });
    const [hips, spine, chest, head] = joints;
    gltf.clip("sway", [
        [hips, "translation", [0, 0.5, 1.25], [[0, 0, 0], [0.002, 0.001, 0.0005], [0, 0, 0]]],
        [spine, "rotation", [0, 0.5, 1.25], [turn(X, 0), turn(X, 0.7), turn(Y, -0.4)]],
        [chest, "rotation", [0, 0.25, 1.25], [turn(Z, 0.2), turn(Z, -1.1), turn(X, 0.3)]],
        [head, "scale", [0, 1], [[1, 1, 1], [1.5, 1.25, 0.75]]],
    ]);
    return { "armature.glb": gltf.glb() };
}

// Many meshes on one rig: each skin has some of the joints in an order of its own, and meshes without a skin hang on
// joints.
function rig() {
    const gltf = new Gltf();
    const root = gltf.node(undefined, { name: "root", translation: [0.5, 0, -0.25], rotation: turn(Y, 0.3) });
    const [hips, spine, neck] = chain(gltf, root, ["hips", "spine", "neck"], [0, 0.5, 0]);
    const arm = (side, x) => {
        const shoulder = gltf.node(spine, {
            name: `shoulder${side}`, translation: [x, 0.4, 0], rotation: turn(Z, (-x * Math.PI) / 0.5),
        });
        return [shoulder, ...chain(gltf, shoulder, [`elbow${side}`, `hand${side}`], [0, 0.4, 0])
            .map((joint, at) => (gltf.json.nodes[joint].translation = [0, 0.4, 0.1 * at], joint))];
    };
    const [left, right] = [arm("L", 0.25), arm("R", -0.25)];
    const all = [neck, ...left, hips, ...right, spine];
    const whole = gltf.skin(all, binds(gltf, all));
    const upper = [spine, neck];
    const scarf = gltf.skin(upper, binds(gltf, upper));
    const sleeve = (joints) => gltf.skin([...joints].reverse(), binds(gltf, [...joints].reverse(), {
        mesh: world(gltf, joints[0]),
    }));
    const stand = new Matrix4().makeTranslation(0.5, 0, -0.25);
    const body = limb({ to: 1, radius: 0.2, joints: [4, 8, 0] });
    moved(body, stand);
    const wrap = limb({ from: 0.7, to: 1.1, radius: 0.25, joints: [0, 1], rings: 3 });
    moved(wrap, stand);
    gltf.node(undefined, { name: "body", mesh: gltf.mesh(gltf.primitive(body), gltf.primitive(wrapOf(wrap))), skin: whole });
    gltf.node(undefined, { name: "scarf", mesh: gltf.mesh(gltf.primitive(wrap)), skin: scarf });
    const cuff = gltf.mesh(gltf.primitive(limb({ to: 0.8, radius: 0.08, joints: [2, 1, 0], rings: 3 })));
    gltf.node(root, { name: "sleeveL", mesh: cuff, skin: sleeve(left), scale: [3, 3, 3] });
    gltf.node(hips, { name: "sleeveR", mesh: cuff, skin: sleeve(right) });
    const thing = gltf.mesh(gltf.primitive(bare(limb({ from: -0.1, to: 0.5, radius: 0.08, rings: 2, sides: 3 }))));
    const grip = gltf.node(right[2], { name: "grip", rotation: turn(X, 1.2), scale: [1, 2, 1] });
    gltf.node(grip, { name: "sword", mesh: thing, rotation: turn(Z, 0.4) });
    gltf.node(left[2], { name: "torch", mesh: thing, translation: [0, 0.05, 0.1] });
    gltf.node(neck, { name: "hat", mesh: thing, scale: [2, 0.5, 4] });
    gltf.node(undefined, { name: "post", mesh: thing, translation: [2, 0, 0] });
    gltf.clip("wave", [
        [root, "translation", [0, 1], [[0.5, 0, -0.25], [1.5, 0.25, 0]]],
        [hips, "rotation", [0, 0.4, 1], [turn(Y, 0), turn(Y, 1.2), turn(Z, 0.2)]],
        [left[0], "rotation", [0, 1], [turn(Z, -1.57), turn(X, 0.8)]],
        [left[1], "rotation", [0, 0.3, 1], [turn(X, 0), turn(X, 1.4), turn(X, 0.1)]],
        [right[1], "rotation", [0.1, 0.9], [turn(Y, 0.5), turn(Z, -0.9)]],
    ]);
    gltf.clip("bow", [
        [spine, "rotation", [0, 0.75], [turn(X, 0), turn(X, 1.3)]],
        [grip, "rotation", [0, 0.75], [turn(X, 1.2), turn(X, -0.6)]],
        [neck, "scale", [0, 0.75], [[1, 1, 1], [1.2, 0.9, 1.1]]],
    ]);
    return { "rig.glb": gltf.glb() };
}

function moved(shape, matrix) {
    const place = new Vector3();
    for (let at = 0; at < shape.positions.length; at += 3) {
        place.fromArray(shape.positions, at).applyMatrix4(matrix).toArray(shape.positions, at);
    }
}

// The same shape for the skin of the whole rig, in which spine and neck have other indices.
function wrapOf(shape) {
    return { ...shape, joints: shape.joints.map((joint) => [8, 0][joint]) };
}

// Mirrored and unevenly scaled: joints below a mirrored node; a mirrored joint that was bound unmirrored, beside one that
// is not mirrored; and one that was bound mirrored. Joints turn below uneven scales, so that matrices are sheared. Boxes
// hang on these joints.
function mirrored() {
    const gltf = new Gltf();
    const mirror = gltf.node(undefined, { name: "mirror", scale: [-1, 1, 1], translation: [0.5, 0, 0] });
    const uneven = gltf.node(mirror, { name: "uneven", scale: [1, 1.5, 0.75], rotation: turn([1, 1, 0], 0.4) });
    const [low, middle, high] = chain(gltf, uneven, ["low", "middle", "high"], [0, 0.5, 0]);
    const joints = [low, middle, high];
    // Bound below the mirroring node: the pose turns it outside in.
    const skin = gltf.skin(joints, binds(gltf, joints, { top: uneven }));
    const tail = gltf.mesh(gltf.primitive(limb({ radius: 0.2, joints: [0, 1, 2] })));
    gltf.node(undefined, { name: "tail", mesh: tail, skin });
    // Bound in its pose: it looks as it was modelled.
    const seen = gltf.skin(joints, binds(gltf, joints));
    const coat = limb({ radius: 0.3, joints: [0, 1, 2], rings: 3 });
    gltf.node(mirror, { name: "coat", mesh: gltf.mesh(gltf.primitive(coat)), skin: seen });
    const bone = gltf.node(undefined, { name: "bone", translation: [2, 0, 0] });
    const plain = gltf.node(bone, { name: "plain", translation: [0, 0, 0.5] });
    const twin = gltf.node(bone, { name: "twin", translation: [0, 0, -0.5], scale: [1, 1, -1] });
    const pair = gltf.skin([plain, twin], [new Matrix4().toArray(), new Matrix4().toArray()]);
    const hands = joined(follows(box([0.2, 0.4, 0.1], [0, 0, 0.3]), 0), follows(box([0.3, 0.2, 0.1], [0, 0.1, 0.3]), 1));
    gltf.node(undefined, { name: "hands", mesh: gltf.mesh(gltf.primitive(hands)), skin: pair });
    const brick = gltf.mesh(gltf.primitive(box([0.3, 0.2, 0.5], [0.1, 0.2, 0.3])));
    gltf.node(high, { name: "lamp", mesh: brick });
    gltf.node(middle, { name: "twice", mesh: brick, scale: [1, -1, 2], rotation: turn(Z, 0.5) });
    gltf.node(twin, { name: "ring", mesh: brick });
    gltf.node(undefined, { name: "point", mesh: brick, scale: [-1, -1, -1], translation: [0, 2, 0] });
    gltf.clip("wag", [
        [uneven, "rotation", [0, 1], [turn([1, 1, 0], 0.4), turn([0, 1, 1], 1.1)]],
        [middle, "rotation", [0, 0.5, 1], [turn(X, 0), turn(Z, 0.7), turn(X, -0.4)]],
        [high, "rotation", [0, 1], [turn(Y, 0), turn(X, 0.6)]],
        [high, "scale", [0, 1], [[1, 1, 1], [1.5, 0.5, 1]]],
        [bone, "rotation", [0, 1], [turn(Y, 0), turn([1, 2, 3], 2)]],
        [twin, "rotation", [0, 1], [turn(X, 0), turn(X, 0.8)]],
    ]);
    return { "mirrored.glb": gltf.glb() };
}

// One rig with two skins, whose inverse bind matrices for the same joints differ, and whose meshes have other spaces.
function bound() {
    const gltf = new Gltf();
    const joints = chain(gltf, undefined, ["foot", "knee", "thigh"], [0, 0.6, 0.1]);
    const first = gltf.skin(joints, binds(gltf, joints));
    // This mesh was modelled lying down, ten times as large and at another position.
    const lying = local({ translation: [0.3, -0.5, 0.2], rotation: turn(X, Math.PI / 2), scale: [0.1, 0.1, 0.1] });
    const second = gltf.skin([...joints].reverse(), binds(gltf, [...joints].reverse(), { mesh: lying }));
    const shape = limb({ to: 1.2, radius: 0.15, joints: [0, 1, 2] });
    gltf.node(undefined, { name: "leg", mesh: gltf.mesh(gltf.primitive(shape)), skin: first });
    const boot = gltf.mesh(gltf.primitive(limb({ to: 9, radius: 2, joints: [2, 1], rings: 4 })));
    gltf.node(joints[1], { name: "boot", mesh: boot, skin: second, translation: [7, 8, 9] });
    // A skin without inverse bind matrices has the identity for every joint.
    const third = gltf.push("skins", { joints: [joints[1]] });
    const ring = gltf.mesh(gltf.primitive(follows(box([0.2, 0.1, 0.2]), 0)));
    gltf.node(undefined, { name: "ring", mesh: ring, skin: third });
    gltf.clip("kick", [
        [joints[0], "rotation", [0, 0.6], [turn(Z, 0), turn(Z, 0.5)]],
        [joints[1], "rotation", [0, 0.3, 0.6], [turn(X, 0), turn(X, -1.5), turn(X, 0.4)]],
        [joints[2], "translation", [0, 0.6], [[0, 0.6, 0.1], [0.1, 0.7, 0]]],
    ]);
    return { "bound.glb": gltf.glb() };
}

// Vertices whose weights are all 0, as exporters write them where nobody painted weights: each follows the joint in its first
// slot.
function unweighted() {
    const gltf = new Gltf();
    const joints = chain(gltf, undefined, ["stem", "bough", "twig"], [0, 0.5, 0]);
    const skin = gltf.skin(joints, binds(gltf, joints));
    const nest = follows(box([0.3, 0.2, 0.4], [0.2, 1.2, 0]), 2);
    nest.joints = nest.joints.map((_, at) => [2, 1, 0, 1][at % 4]);
    nest.weights.fill(0);
    const shape = joined(limb({ to: 1, radius: 0.1, joints: [0, 1, 2] }), nest);
    gltf.node(undefined, { name: "tree", mesh: gltf.mesh(gltf.primitive(shape)), skin });
    gltf.clip("storm", [
        [joints[0], "rotation", [0, 1], [turn(Z, 0), turn(Z, 0.3)]],
        [joints[1], "rotation", [0, 0.5, 1], [turn(X, 0), turn(X, 0.8), turn(Z, -0.6)]],
        [joints[2], "translation", [0, 1], [[0, 0.5, 0], [0.2, 0.6, 0.1]]],
    ]);
    return { "unweighted.glb": gltf.glb() };
}

// Weights of two joints whose integers sum exactly to 1, as glTF requires.
function whole(weights, one) {
    const first = (at) => Math.round(weights[at - (at % 4)] * one) / one;
    return weights.map((_, at) => [first(at), 1 - first(at), 0, 0][at % 4]);
}

// Small integers for fractions and for positions (KHR_mesh_quantization), interleaved attributes, sparse accessors with
// and without a base, indices of every size, and a buffer in a file of its own.
function packed() {
    const gltf = new Gltf();
    gltf.json.extensionsUsed = gltf.json.extensionsRequired = ["KHR_mesh_quantization"];
    const joints = chain(gltf, undefined, ["base", "stalk", "tip"], [0, 0.5, 0]);
    // Positions are in 1/1000.
    const finer = new Matrix4().makeScale(0.001, 0.001, 0.001);
    const skin = gltf.skin(joints, binds(gltf, joints, { mesh: finer }));
    const shape = limb({ to: 1, radius: 0.2, joints: [0, 1, 2] });
    const positions = shape.positions.map((metres) => Math.round(1000 * metres));
    const [POSITION, NORMAL] = gltf.interleaved([
        { type: "VEC3", values: positions, component: I16, bounds: true },
        { type: "VEC3", values: shape.normals, component: I8, normalized: true },
    ]);
    const [JOINTS_0, WEIGHTS_0] = gltf.interleaved([
        { type: "VEC4", values: shape.joints, component: U8 },
        { type: "VEC4", values: whole(shape.weights, 255), component: U8, normalized: true },
    ]);
    const fine = gltf.accessor("VEC4", whole(shape.weights, 65535), { component: U16, normalized: true });
    const wide = gltf.accessor("VEC4", shape.joints, { component: U16 });
    const indices = (component) => gltf.accessor("SCALAR", shape.indices, { component });
    // A sparse accessor moves two vertices of another one; two morph targets are mostly zeros.
    const bumped = gltf.accessor("VEC3", positions, {
        bounds: true, sparse: [[3, [400, 120, 40]], [17, [-350, 800, 10]]],
    });
    const target = (...sparse) => ({ POSITION: gltf.accessor("VEC3", undefined, {
        bounds: true, count: positions.length / 3, sparse,
    }) });
    const targets = [target([0, [0, -300, 0]], [8, [100, 0, 250]]), target([8, [50, 60, 70]], [16, [0, 500, 0]])];
    const first = { attributes: { POSITION, NORMAL, JOINTS_0, WEIGHTS_0 }, indices: indices(U8) };
    const second = { attributes: { POSITION, NORMAL, JOINTS_0: wide, WEIGHTS_0: fine }, indices: indices(U32) };
    const third = { attributes: { POSITION: bumped, JOINTS_0, WEIGHTS_0: fine }, indices: indices(U16), targets };
    const stem = gltf.node(undefined, { name: "stem", mesh: gltf.mesh(first, second), skin });
    const bud = gltf.node(undefined, { name: "bud", mesh: gltf.mesh(third), skin });
    gltf.json.nodes[stem].rotation = turn(Y, 1);
    gltf.json.meshes[1].weights = [0.25, 0];
    const turns = (component, times, ...rotations) => ["rotation", times, rotations.map((q) => exact(q, component)), {
        component, normalized: true,
    }];
    gltf.clip("grow", [
        [joints[1], ...turns(I16, [0, 0.5, 1], turn(X, 0.1), turn([3, 1, 0], 1), turn(Z, -0.8))],
        [joints[2], ...turns(I8, [0, 1], turn(Y, 0), turn([1, 0, 2], 1.2))],
        [bud, "weights", [0, 0.5, 1], [[0, 1], [1, 0.2], [0.6, 0.6]], { component: U8, normalized: true }],
    ]);
    return { "packed.gltf": gltf.gltf("packed.bin"), "packed.bin": Buffer.from(gltf.bytes) };
}

// Every interpolation of every part: steps, cubic splines, rotations by more than half a turn and to a quaternion's
// negative; keys that begin late, keys that end early, and single keys.
function keys() {
    const gltf = new Gltf();
    const names = ["step", "spline", "arc", "late"];
    const joints = chain(gltf, undefined, names, [0, 0.5, 0]);
    const skin = gltf.skin(joints, binds(gltf, joints));
    const shape = limb({ to: 1.5, radius: 0.2, joints: [0, 1, 2, 3], rings: 7 });
    const vertices = shape.positions.length / 3;
    const target = (axis, size) => ({
        POSITION: gltf.accessor("VEC3", Array.from({ length: 3 * vertices }, (_, at) =>
            at % 3 === axis ? size * Math.sin(at) : 0), { bounds: true }),
    });
    const morphing = (name) => {
        const mesh = gltf.mesh(gltf.primitive(shape, { targets: [target(0, 0.2), target(2, 0.1)] }));
        return gltf.node(undefined, { name, mesh, skin });
    };
    const [stepped, splined, straight] = ["stepped", "splined", "straight"].map(morphing);
    const [step, spline, arc, late] = joints;
    const [STEP, CUBICSPLINE] = [{ interpolation: "STEP" }, { interpolation: "CUBICSPLINE" }];
    const q = [turn(X, 0), turn([1, 2, 0], 1.1), turn(Z, -2), turn(Y, 0.4)];
    const flipped = (rotation) => rotation.map((component) => -component);
    // In-tangent, value, out-tangent.
    const tangents = (values, size) => values.flatMap((value, at) => [
        value.map((_, axis) => size * Math.cos(3 * at + axis)), value, value.map((_, axis) => size * Math.sin(2 * at - axis)),
    ]);
    const times = [0, 0.375, 1, 1.5];
    gltf.clip("every", [
        [step, "translation", times, [[0, 0, 0], [0.25, 0, 0], [0, 0.5, 0], [0, 0, 1]], STEP],
        [step, "rotation", times, q, STEP],
        [step, "scale", [0.5, 1], [[1, 1, 1], [2, 1, 0.5]], STEP],
        [spline, "translation", times, tangents([[0, 0.5, 0], [0.1, 0.6, 0], [0, 0.4, 0.1], [0, 0.5, 0]], 0.3), CUBICSPLINE],
        [spline, "rotation", times, tangents([q[0], q[1], flipped(q[2]), q[3]], 0.5), CUBICSPLINE],
        [spline, "scale", [0, 1.5], tangents([[1, 1, 1], [1.5, 0.75, 1]], 0.2), CUBICSPLINE],
        [arc, "rotation", [0, 0.25, 0.75, 1.5], [q[0], flipped(q[1]), turn(X, 3), turn(X, 6.5)]],
        [arc, "translation", [0.25, 0.75], [[0, 0.5, 0], [0.2, 0.3, 0.1]]],
        [late, "rotation", [0.6, 1.2], [q[1], q[3]]],
        [late, "translation", [0.8], [[0.1, 0.7, 0.2]]],
        [late, "scale", [0.7], tangents([[1.5, 1, 0.75]], 0.4), CUBICSPLINE],
        [stepped, "weights", times, [[0, 1], [1, 0], [0.5, 0.5], [0, 0]], STEP],
        [splined, "weights", [0, 1.5], [[0.1, 0], [0, 1], [0, 0.3], [-0.2, 0], [1, 0.5], [0, 0]], CUBICSPLINE],
        [straight, "weights", [0.5, 1], [[0, -0.5], [1.5, 1]]],
    ]);
    return { "keys.glb": gltf.glb() };
}

// Without a skin: a clip moves the parts of a machine, each a child of the one before; one part morphs.
function parts() {
    const gltf = new Gltf();
    const wagon = gltf.node(undefined, { name: "wagon", mesh: gltf.mesh(gltf.primitive(box([2, 0.5, 1]))) });
    const wheel = gltf.mesh(gltf.primitive(bare(limb({ from: -0.1, to: 0.1, radius: 0.3, rings: 2, sides: 6 }))));
    const wheels = [-1, 1].map((side) => gltf.node(wagon, {
        name: side < 0 ? "front" : "back", mesh: wheel, translation: [0.7 * side, -0.3, 0.5 * side],
        rotation: turn(X, (side * Math.PI) / 2),
    }));
    const turret = gltf.node(wagon, { name: "turret", translation: [0, 0.3, 0], scale: [1, 1.4, 0.8] });
    const boom = gltf.node(turret, {
        name: "boom", mesh: gltf.mesh(gltf.primitive(box([0.2, 1.5, 0.2], [0, 0.75, 0]))), rotation: turn(Z, 0.5),
    });
    const matrix = local({ translation: [0, 1.5, 0], rotation: turn(Z, 1), scale: [-1, 0.5, 2] }).toArray();
    const hook = gltf.node(boom, { name: "hook", mesh: gltf.mesh(gltf.primitive(box([0.3, 0.3, 0.1]))), matrix });
    const blob = box([0.5, 0.5, 0.5]);
    const swollen = { POSITION: gltf.accessor("VEC3", blob.positions.map((at, axis) => [0.8, 0.2, 1.5][axis % 3] * at), { bounds: true }) };
    const load = gltf.node(hook, { name: "load", mesh: gltf.mesh(gltf.primitive(blob, { targets: [swollen] })) });
    gltf.node(undefined, { name: "kerb", mesh: wheel, translation: [3, 0, 0] });
    gltf.clip("drive", [
        [wagon, "translation", [0, 2], [[0, 0, 0], [4, 0, 1]]],
        ...wheels.map((node, at) => [node, "rotation", [0, 0.5, 1, 2], [0, 2, 4, 8].map((angle) => {
            const side = turn(X, (at === 0 ? -1 : 1) * (Math.PI / 2));
            return new Quaternion(...side).multiply(new Quaternion(...turn(Y, angle))).toArray();
        })]),
        [turret, "rotation", [0, 1.5, 2], [turn(Y, 0), turn(Y, 2.5), turn(Y, 1)]],
        [boom, "rotation", [0, 2], [turn(Z, 0.5), turn(Z, -0.7)]],
        [load, "weights", [0, 1, 2], [[0], [1], [0.25]]],
    ]);
    return { "parts.glb": gltf.glb() };
}

// Without skin and clip: nodes with and without matrices, meshes of several primitives, and one mesh at several nodes.
function still() {
    const gltf = new Gltf();
    const stone = gltf.mesh(gltf.primitive(box([1, 0.5, 0.75])), gltf.primitive(box([0.2, 0.2, 0.2], [0, 0.5, 0])));
    const wall = gltf.node(undefined, { name: "wall", mesh: stone, rotation: turn([1, 2, 3], 0.8), scale: [2, 1, 1] });
    gltf.node(wall, { name: "ledge", mesh: stone, translation: [0.5, 0.5, 0.5], rotation: turn(Y, 0.7), scale: [0.5, 0.5, 0.5] });
    const matrix = local({ translation: [-3, 1, 2], rotation: turn([3, 1, 0], 2), scale: [1, -1, 3] }).toArray();
    const empty = gltf.node(undefined, { name: "empty", matrix });
    gltf.node(empty, { name: "far", mesh: stone, translation: [0, 0, 1] });
    return { "still.glb": gltf.glb() };
}

// Three scenes, of which the second is the default. It shares a node with the first. It has neither the nodes of the
// third scene nor the node of no scene, and no channel of a clip that moves these.
function scenes() {
    const gltf = new Gltf();
    gltf.json.scenes = [{ nodes: [] }, { nodes: [] }, { nodes: [] }];
    gltf.json.scene = 1;
    const brick = gltf.mesh(gltf.primitive(box([1, 0.5, 0.75])));
    const other = gltf.node(null, { name: "other", mesh: brick, translation: [9, 9, 9] });
    const shared = gltf.node(undefined, { name: "shared", mesh: brick, translation: [0, -1, 0] });
    const joints = chain(gltf, undefined, ["lower", "upper"], [0, 0.5, 0]);
    const skin = gltf.skin(joints, binds(gltf, joints));
    const snake = gltf.mesh(gltf.primitive(limb({ radius: 0.2 })));
    gltf.node(undefined, { name: "snake", mesh: snake, skin });
    gltf.json.scenes[0].nodes.push(other, shared);
    const away = gltf.node(null, { name: "away", mesh: brick, scale: [5, 5, 5] });
    const adder = gltf.node(null, { name: "adder", mesh: brick });
    gltf.json.scenes[2].nodes.push(away);
    gltf.clip("move", [
        [joints[1], "rotation", [0, 1], [turn(X, 0), turn(Z, 1)]],
        [shared, "rotation", [0, 1], [turn(X, 0), turn(Y, 1)]],
        [away, "rotation", [0, 1], [turn(X, 0), turn(Y, 1)]],
        [adder, "translation", [0, 1], [[0, 0, 0], [1, 1, 1]]],
    ]);
    return { "scenes.glb": gltf.glb() };
}

export function files() {
    return Object.assign({}, ...[armature, rig, mirrored, bound, unweighted, packed, keys, parts, still, scenes].map((make) => make()));
}
