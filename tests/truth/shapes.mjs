// Small closed shapes, counter-clockwise seen from outside, with the joints and weights of their vertices.

// A box around the origin; each side has its own four corners.
export function box([x, y, z], [cx, cy, cz] = [0, 0, 0]) {
    const [positions, normals, indices] = [[], [], []];
    for (let axis = 0; axis < 3; axis++) {
        for (const side of [-1, 1]) {
            const first = positions.length / 3;
            for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
                const corner = [0, 0, 0];
                corner[axis] = side;
                corner[(axis + 1) % 3] = u * side;
                corner[(axis + 2) % 3] = v;
                positions.push(cx + (corner[0] * x) / 2, cy + (corner[1] * y) / 2, cz + (corner[2] * z) / 2);
                normals.push(...[0, 1, 2].map((at) => (at === axis ? side : 0)));
            }
            indices.push(...[0, 1, 2, 0, 2, 3].map((corner) => first + corner));
        }
    }
    return { positions, normals, indices };
}

// A limb along +Y from `from` to `to` that follows a chain of joints; each ring of vertices follows two of them.
export function limb({ from = 0, to = 1, radius, rings = 4, sides = 4, joints = [0, 1] }) {
    const shape = { positions: [], normals: [], indices: [], joints: [], weights: [] };
    const add = (position, normal, way) => {
        const place = way * (joints.length - 1);
        const below = Math.min(Math.floor(place), Math.max(joints.length - 2, 0));
        const weight = place - below;
        shape.positions.push(...position);
        shape.normals.push(...normal);
        // Where the weight is 0, the joint is the first one.
        const above = weight > 0 ? joints[below + 1] : 0;
        shape.joints.push(weight < 1 ? joints[below] : 0, above, 0, 0);
        shape.weights.push(1 - weight, weight, 0, 0);
        return shape.positions.length / 3 - 1;
    };
    const bottom = add([0, from, 0], [0, -1, 0], 0);
    for (let ring = 0; ring < rings; ring++) {
        const way = ring / (rings - 1);
        for (let side = 0; side < sides; side++) {
            const angle = (2 * Math.PI * (side + 0.25)) / sides;
            // The section is not round, so that the mirror image differs from the shape.
            const [x, z] = [Math.cos(angle) * (1 + 0.3 * Math.sin(angle)), Math.sin(angle)];
            const length = Math.hypot(x, z);
            add([radius * x, from + (to - from) * way, radius * z], [x / length, 0, z / length], way);
        }
    }
    const top = add([0, to, 0], [0, 1, 0], 1);
    const at = (ring, side) => 1 + ring * sides + (side % sides);
    for (let side = 0; side < sides; side++) {
        shape.indices.push(bottom, at(0, side), at(0, side + 1));
        shape.indices.push(top, at(rings - 1, side + 1), at(rings - 1, side));
        for (let ring = 0; ring + 1 < rings; ring++) {
            const [a, b, c, d] = [at(ring, side), at(ring, side + 1), at(ring + 1, side + 1), at(ring + 1, side)];
            shape.indices.push(a, c, b, a, d, c);
        }
    }
    return shape;
}

// A shape without joints.
export function bare({ positions, normals, indices }) {
    return { positions, normals, indices };
}

// A shape that follows one joint rigidly.
export function follows(shape, joint) {
    const vertices = shape.positions.length / 3;
    const all = (four) => Array.from({ length: vertices }, () => four).flat();
    return { ...shape, joints: all([joint, 0, 0, 0]), weights: all([1, 0, 0, 0]) };
}

// Joins several shapes to one.
export function joined(...shapes) {
    const all = { positions: [], normals: [], indices: [], joints: [], weights: [] };
    for (const shape of shapes) {
        const first = all.positions.length / 3;
        for (const name of ["positions", "normals", "joints", "weights"]) all[name].push(...shape[name]);
        all.indices.push(...shape.indices.map((index) => index + first));
    }
    return all;
}

// A rotation about an axis, as glTF has it.
export function turn([x, y, z], angle) {
    const length = Math.hypot(x, y, z);
    const sine = Math.sin(angle / 2) / length;
    return [x * sine, y * sine, z * sine, Math.cos(angle / 2)];
}
