// node --test   checks how `dump.mjs` compares vertices

import assert from "node:assert/strict";
import { test } from "node:test";
import { Matrix4, Vector4 } from "three";
import { Apart } from "./apart.mjs";

// Looks along -Z; at a distance of 1 the picture reaches from -1 to 1, and a pixel is 0.01.
const camera = {
    view_from_world: new Matrix4().toArray(),
    clip_from_view: new Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.001, -0.1001, 0, 0, -1, 0).toArray(),
    viewport: [200, 200],
};

function apart(...pairs) {
    const all = new Apart();
    for (const [right, found] of pairs) all.add(camera, new Vector4(...right, 1), new Vector4(...found, 1));
    return all;
}

const near = (found, wanted) => assert.ok(Math.abs(found - wanted) < 1e-9, `${found}, not ${wanted}`);

test("vertices in the picture are compared in pixels", () => {
    const all = apart([[0, 0, -1], [0, 0, -1]], [[0.5, 0, -1], [0.53, 0.04, -1]]);
    assert.equal(all.inside.count, 2);
    near(all.inside.worst, 5);
    assert.ok(all.holds(5.01) && !all.holds(4.99));
});

test("a vertex at the very edge is counted apart, with its distance", () => {
    for (const pair of [[[1, 0, -1], [1.00001, 0, -1]], [[0, -1.00001, -1], [0, -1, -1]]]) {
        const all = apart([[0, 0, -1], [0, 0, -1]], pair);
        assert.deepEqual([all.inside.count, all.inside.worst, all.edge.count], [1, 0, 1]);
        near(all.edge.worst, 0.001);
        assert.ok(all.holds(0.01));
        assert.match(`${all}`, /^1 vertices: 0\.0000 pixels apart at most, 1 at the picture's edge: 0\.0010$/);
    }
});

test("a vertex that leaves the picture is found", () => {
    const all = apart([[0, 0, -1], [0, 0, -1]], [[0.99, 0, -1], [1.5, 0, -1]]);
    near(all.edge.worst, 51);
    assert.ok(!all.holds(0.01));
});

test("a vertex behind the camera is infinitely far away, and one outside is left out", () => {
    assert.equal(apart([[0, 0, -1], [0, 0, 1]]).edge.worst, Infinity);
    assert.equal(apart([[3, 0, -1], [0, 0, 1]]).edge.count, 0);
    assert.ok(!apart([[3, 0, -1], [3, 0, -1]]).holds(1));
});
