"""Scenes in both planes, and each of their planes as a scene in one."""

import dataclasses

import numpy as np

import ropedyn as rd

ROLE = {"y": "z", "gamma": "beta"}


def in_plane_of_z(name):
    """What a coordinate or an internal force of the plane of y is called in that of z."""
    head, _, tail = name.rpartition("_")
    return f"{head}_{ROLE.get(tail, tail)}".removeprefix("_")


def turned(point):
    """A point of the plane of y in that of z."""
    if point[0] == "end":
        return (*point[:2], ROLE.get(point[2], point[2]))
    return (in_plane_of_z(point[0]), point[1])


def plane(scene, name):
    """One plane of a scene in both as a scene of its own, in z."""
    if name == "z":
        return scene.without("second plane")
    rope = scene.rope
    own = {
        "bending_stiffness": second(rope.bending_stiffness),
        "rotary_inertia": second(rope.rotary_inertia),
    }
    bare = rd.Rope(rope.length, rope.linear_density, **own)
    parts = [turned_part(part) for part in scene.parts if acts_across(part)]
    ends = [turned_end(rd.End() if end == "clamped" else end) for end in scene.ends]
    return scene.replace(
        rope=bare, parts=parts, ends=ends, planes="z", tension=scene.tension, gravity=None
    )


def second(value):
    return value[1] if isinstance(value, tuple) else value


def acts_across(part):
    acting = getattr(part, "coordinate", getattr(part, "plane", "y"))
    return acting in (*ROLE, "y")


def turned_part(part):
    if hasattr(part, "coordinate"):
        return dataclasses.replace(part, coordinate=ROLE[part.coordinate])
    if hasattr(part, "plane"):
        return dataclasses.replace(part, plane="z")
    if isinstance(part, rd.LocalChange):
        return dataclasses.replace(part, bending=second(part.bending), torsion=1.0, axial=1.0)
    return part


def turned_end(end):
    given = {
        name: {ROLE[c]: v for c, v in getattr(end, name).items() if c in ROLE}
        for name in ("spring", "dashpot", "mass")
    }
    return rd.End(z=end.y, beta=end.gamma, **given)


def random_end(rng):
    """Each coordinate held, free or on a spring, in each plane on its own."""
    kept, spring = {}, {}
    for across, turning in (("z", "beta"), ("y", "gamma")):
        if rng.random() < 0.2:
            kept[across], spring[across] = "free", 10 ** rng.uniform(1, 4)
        if rng.random() < 0.6:
            kept[turning] = "free"
            if rng.random() < 0.5:
                spring[turning] = 10 ** rng.uniform(-1, 2)
    return kept, spring


def random_part(rng, length):
    """What acts in one plane, or in both."""
    x, name = float(rng.uniform(0.05, 0.95) * length), rng.choice(["z", "y"])
    turning = {"z": "beta", "y": "gamma"}[name]
    size = float(10 ** rng.uniform(-3, -1))
    pair = tuple(rng.uniform(0.3, 3.0, 2).tolist())
    return [
        lambda: rd.PointMass(x, size, rotary_inertia=size * 1e-3),
        lambda: rd.Spring(x, 1e5 * size, coordinate=name),
        lambda: rd.Spring(x, 1e3 * size, coordinate=turning),
        lambda: rd.Dashpot(x, 10 * size, coordinate=name),
        lambda: rd.Support(x, coordinate=name),
        lambda: rd.Hinge(x, stiffness=1e2 * size, plane=name),
        lambda: rd.Resonator(x, size, 30.0 + 1e3 * size, damping_ratio=0.02, plane=name),
        lambda: rd.AddedMass(x / 2, x, size),
        lambda: rd.LocalChange(x / 2, x, bending=pair, density=pair[0]),
    ][rng.integers(9)]()


def random_scene(rng, *, bends=None):
    """A scene in both planes: a string or a beam, with parts that act in one plane or both."""
    length = float(rng.uniform(0.5, 4.0))
    rope = {}
    if rng.random() < 0.75 if bends is None else bends:
        rope["bending_stiffness"] = tuple((10 ** rng.uniform(-1, 2, 2)).tolist())
        if rng.random() < 0.5:
            rope["rotary_inertia"] = tuple((10 ** rng.uniform(-6, -4, 2)).tolist())
    parts = [random_part(rng, length) for _ in range(rng.integers(0, 5))]
    ends = [random_end(rng) for _ in range(2)]
    if not rope:
        turning = ("beta", "gamma")
        parts = [p for p in parts if not isinstance(p, (rd.Hinge, rd.LocalChange))]
        parts = [p for p in parts if getattr(p, "coordinate", "z") not in turning]
        ends = [(k, {c: v for c, v in s.items() if c not in turning}) for k, s in ends]
    return rd.Scene(
        rd.Rope(length, float(rng.uniform(0.05, 1.0)), **rope),
        tension=float(10 ** rng.uniform(1.5, 4)),
        ends=[rd.End(**kept, spring=spring) for kept, spring in ends],
        parts=parts,
        planes="both",
    )


def pairs(seed, count, **options):
    """So many random scenes with their planes; those whose parts cannot stand are left out."""
    rng = np.random.default_rng(seed)
    made = 0
    while made < count:
        try:
            both = random_scene(rng, **options)
            both.compile()
            own = {name: plane(both, name) for name in ("z", "y")}
        except rd.SceneError:
            continue
        made += 1
        yield both, own
