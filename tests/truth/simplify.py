"""Distances between meshes and their levels, measured by libigl, for levels that `cargo bench --bench simplify` wrote.

python3 -m venv venv && venv/bin/pip install libigl && venv/bin/python tests/truth/simplify.py DIR

DIR has MESH[_normals|_model].obj, and MESH[_normals|_model]_PERCENT_{relievo,meshoptimizer}.obj; and where the benchmark ran
with `--within`, MESH…_within.obj, which `simplify_within` made.
Both directions are measured, at the vertices that are used, at the middles of edges and of triangles, and at points spread
evenly over the area: root mean square (over the latter alone, since only these are spread evenly) and largest. Where
normals count, so do their differences, at points spread evenly over the mesh and the nearest points of the level: the root
mean square length. Prints a table of both programs and their ratios, and the geometric means of the ratios.
"""

import pathlib
import re
import sys

import igl
import numpy

SAMPLES = 200_000


def read(path):
    """Vertices, triangles and normals of a file that the benchmark wrote."""
    with open(path) as file:
        lines = [line.split() for line in file]
    positions, normals = (numpy.array([line[1:4] for line in lines if line[0] == key], dtype=float) for key in ("v", "vn"))
    corners = [[corner.split("/")[0] for corner in line[1:4]] for line in lines if line[0] == "f"]
    return positions, numpy.array(corners, dtype=numpy.int64) - 1, normals


def spread(positions, triangles, count):
    """Points spread evenly over the area, from a fixed seed: the triangle and the weights of its corners."""
    corners = positions[triangles]
    areas = numpy.linalg.norm(numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    random = numpy.random.default_rng(7)
    ends = numpy.cumsum(areas)
    chosen = numpy.minimum(numpy.searchsorted(ends, random.random(count) * ends[-1]), len(areas) - 1)
    root, part = numpy.sqrt(random.random((count, 1))), random.random((count, 1))
    return chosen, numpy.concatenate([1 - root, root * (1 - part), root * part], axis=1)


def at(values, triangles, points):
    """Values of vertices at points of triangles."""
    chosen, weights = points
    return (values[triangles[chosen]] * weights[:, :, None]).sum(axis=1)


def special(positions, triangles):
    """Vertices in use, and middles of edges and triangles."""
    edges = numpy.unique(numpy.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    return numpy.concatenate(
        [positions[numpy.unique(triangles)], positions[edges].mean(axis=1), positions[triangles].mean(axis=1)]
    )


def distances(mesh, level):
    """Root mean square and largest distance, the larger of both directions."""
    rms, largest = 0.0, 0.0
    for source, target in ((mesh[:2], level[:2]), (level[:2], mesh[:2])):
        even = igl.point_mesh_squared_distance(at(*source, spread(*source, SAMPLES)), *target)[0]
        ends = igl.point_mesh_squared_distance(special(*source), *target)[0]
        rms = max(rms, numpy.sqrt(even.mean()))
        largest = max(largest, numpy.sqrt(max(even.max(), ends.max())))
    return rms, largest


def bend(mesh, level):
    """Root mean square difference between the normals of a mesh and those of the nearest points of its level."""
    positions, triangles, normals = mesh
    points = spread(positions, triangles, SAMPLES)
    places = at(positions, triangles, points)
    _, nearest, feet = igl.point_mesh_squared_distance(places, *level[:2])
    corners = [numpy.ascontiguousarray(level[0][level[1][nearest, corner]]) for corner in range(3)]
    weights = numpy.nan_to_num(igl.barycentric_coordinates(numpy.ascontiguousarray(feet), *corners), nan=1 / 3)
    both = [at(normals, triangles, points), at(level[2], level[1], (nearest, weights))]
    first, second = (many / numpy.maximum(numpy.linalg.norm(many, axis=1, keepdims=True), 1e-9) for many in both)
    return numpy.sqrt(((first - second) ** 2).sum(axis=1).mean())


def main(folder):
    pattern = re.compile(r"(.+?)(_normals|_model)?_(\d+)_relievo\.obj")
    found = [match for match in map(lambda path: pattern.fullmatch(path.name), sorted(folder.iterdir())) if match]
    meshes, ratios = {}, {}
    print("| mesh | counted | % | triangles | rms | largest | bend | rms, ratio | largest, ratio | bend, ratio "
          "| within: triangles | rms | largest |\n" + "|---" * 13 + "|")
    for match in sorted(found, key=lambda match: (match[1], match[2] or "", -int(match[3]))):
        name, counted, percent = match[1], match[2] or "", match[3]
        mesh = meshes.setdefault(name + counted, None) or read(folder / f"{name}{counted}.obj")
        meshes[name + counted] = mesh
        levels = [read(folder / f"{name}{counted}_{percent}_{who}.obj") for who in ("relievo", "meshoptimizer")]
        within = folder / f"{name}{counted}_{percent}_within.obj"
        near = ""
        if within.exists():
            level = read(within)
            near = " | ".join([str(len(level[1])), *(f"{number:.4g}" for number in distances(mesh, level))])
        ours, theirs = ((*distances(mesh, level), bend(mesh, level)) for level in levels)
        ratio = [a / b if b > 0 else float(a <= b) for a, b in zip(ours, theirs)]
        ratios.setdefault(counted, []).append(ratio)
        both = [f"{a:.4g} / {b:.4g}" for a, b in zip(ours, theirs)]
        count = " / ".join(str(len(level[1])) for level in levels)
        print(f"| {name} | {counted[1:] or 'nothing'} | {percent} | {count} | {both[0]} | {both[1]} "
              f"| {both[2]} | {ratio[0]:.3f} | {ratio[1]:.3f} | {ratio[2]:.3f} | {near} |", flush=True)
    for counted, all_ratios in ratios.items():
        mean, worst = numpy.exp(numpy.log(numpy.maximum(all_ratios, 1e-9)).mean(axis=0)), numpy.max(all_ratios, axis=0)
        print(f"\n{counted[1:] or 'nothing'} counted: geometric mean of rms {mean[0]:.3f}, of largest {mean[1]:.3f}, of bend "
              f"{mean[2]:.3f}; worst {worst[0]:.3f}, {worst[1]:.3f}, {worst[2]:.3f}")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
