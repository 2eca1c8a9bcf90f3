// How far two places of one vertex are apart in a picture.

import { Matrix4 } from "three";

// A point relative to the camera's cell as the camera projects it: its pixel, and whether it lies in the picture. A point behind
// the camera has no pixel.
function projected({ view_from_world, clip_from_view, viewport }, point) {
    const clip = point.clone().applyMatrix4(new Matrix4().fromArray(view_from_world));
    clip.applyMatrix4(new Matrix4().fromArray(clip_from_view));
    if (!(clip.w > 0)) return { isInside: false };
    const isInside = Math.abs(clip.x) <= clip.w && Math.abs(clip.y) <= clip.w && clip.z >= 0 && clip.z <= clip.w;
    return { isInside, pixel: [0, 1].map((axis) => (0.5 * viewport[axis] * clip.getComponent(axis)) / clip.w) };
}

// Collects pairs of places: the right one and the found one.
export class Apart {
    // Vertices of which both places lie in the picture, and the largest distance between these, in pixels.
    inside = { count: 0, worst: 0 };
    // The same for vertices of which one place lies in the picture: those at its very edge.
    edge = { count: 0, worst: 0 };

    // Adds a vertex; one of which no place lies in the picture is left out. A place behind the camera is infinitely far away.
    add(camera, right, found) {
        const [a, b] = [right, found].map((point) => projected(camera, point));
        if (!a.isInside && !b.isInside) return;
        const group = a.isInside && b.isInside ? this.inside : this.edge;
        const far = a.pixel && b.pixel ? Math.hypot(a.pixel[0] - b.pixel[0], a.pixel[1] - b.pixel[1]) : Infinity;
        group.count += 1;
        group.worst = Math.max(group.worst, far);
    }

    // Whether there are vertices inside, and all are at most `limit` pixels apart, those at the edge too.
    holds(limit) {
        return this.inside.count > 0 && this.inside.worst <= limit && this.edge.worst <= limit;
    }

    toString() {
        const { inside, edge } = this;
        const atEdge = edge.count === 0 ? "" : `, ${edge.count} at the picture's edge: ${edge.worst.toFixed(4)}`;
        return `${inside.count} vertices: ${inside.worst.toFixed(4)} pixels apart at most${atEdge}`;
    }
}
