"""What the gate runs: one small column of sand (column.json), and what a scene may ask for beside it, so that between
them the cases touch every pass, transfer, stencil, effect, solver and output."""
import json


class Case:
    """A name, overrides of the scene, and how many steps are made: what lies between the two counts is counted."""

    def __init__(self, name, *overrides, few=4, more=12, quick=False):
        self.name, self.few, self.more, self.quick = name, few, more, quick
        self.overrides = [o if isinstance(o, str) else f"{o[0]}={json.dumps(o[1])}" for o in overrides]


def solid(name, contact, **more):
    return {"name": name, "contact": contact, "shape": {"type": "plane"}, **more}


FLOOR = solid("floor", "separating", friction=0.4)
BLADE = {"name": "blade", "friction": 0.3, "motion": {"keys": [{"time": 0}, {"time": 1, "translation": [0, -0.5, 0]}]},
         "shape": {"type": "box", "lower": [0.1, 0.7, 0.1], "upper": [0.4, 1.1, 0.4]}}
EVERYWHERE = {"type": "box", "lower": [-9, -9, -9], "upper": [9, 9, 9]}
RUBBER = ("bodies.column.material", "rubber")
IMPLICIT = ("time.integrator", "implicit")

CASES = [
    Case("bare", quick=True),
    Case("double", ("grid.precision", "double"), quick=True),
    *[Case(f"transfer {name}", ("grid.transfer", name), quick=name == "aflip")
      for name in ("apic", "rpic", "pic", "flip", "aflip")],
    *[Case(f"stencil {name}", ("grid.stencil", name), quick=name == "cubic") for name in ("linear", "cubic")],
    Case("plane strain", ("grid.plane_strain", "z"), ("bodies.column.particles_per_cell", 4),
         ("bodies.column.shape", {"type": "box", "lower": [0.03, 0.02, -1], "upper": [0.98, 1.42, 1]})),
    Case("elastic", ("bodies.column.material", "rubber"), quick=True),
    Case("contacts", ("colliders", [solid("floor", "sticky"), BLADE,
                                    {**solid("wall", "slip"), "shape": {"type": "plane", "normal": [1, 0, 0]}}]), quick=True),
    Case("before friction", ("grid.advection", "before_friction")),
    Case("volume_correction", ("volume_correction", {}), quick=True),
    Case("density_correction", ("volume_correction", {}), ("density_correction", {})),
    Case("hardening", ("materials.sand.hardening", {})),
    Case("cohesion", ("materials.sand.cohesion", {"tension": {"limit": 100}})),
    Case("moisture", ("materials.sand.moisture", {"cohesion_change": 500, "initial": 0.5}),
         ("wetting", [{"name": "rain", "shape": EVERYWHERE}])),
    Case("variation", ("materials.sand.variation", {"friction": 0.2})),
    Case("dilatancy", ("materials.sand.dilatancy", {})),
    Case("rate_friction", ("materials.sand.rate_friction", {})),
    Case("prestress", ("prestress", [{"body": "column"}])),
    Case("sleep", ("sleep", {})),
    Case("age", ("age", {})),
    Case("plastic_strain", ("plastic_strain", {})),
    Case("channels", ("channels", [{"name": "Cd", "components": 3}])),
    Case("pins", ("pins", [{"name": "foot", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.07, 1]}}])),
    Case("force_fields", ("force_fields", [{"name": "wind", "type": "wind", "velocity": [1, 0, 0], "shape": EVERYWHERE}])),
    Case("emitters and sinks",
         ("emitters", [{"name": "spout", "material": "sand", "type": "disc", "center": [0.5, 1.5, 0.5], "normal": [0, -1, 0],
                        "radius": 0.2, "speed": 2}]),
         ("sinks", [{"name": "drain", "shape": {"type": "box", "lower": [-1, -1, -1], "upper": [1, 0.05, 1]}}]), more=24),
    Case("probes", ("probes", [{"name": "weight", "type": "force", "collider": "floor"}, {"name": "all", "type": "energy"},
                               {"name": "gate", "type": "flow", "point": [0, 0.3, 0], "normal": [0, 1, 0]}])),
    *[Case(f"implicit {mode}", IMPLICIT, ("implicit.mode", mode), ("time.max_step", 2e-3), few=1, more=3,
           quick=mode == "projected") for mode in ("exact", "projected", "lagged", "unilateral")],
    Case("implicit elastic", IMPLICIT, RUBBER, ("time.max_step", 2e-3), few=1, more=3),
]

# A whole run with everything that it can write.
OUTPUT = Case("output", ("output", {"vdb": True, "checkpoint": True, "surface": {}, "fog": {},
                                    "attributes": ["stress", "pressure", "speed", "density"]}),
              ("time.frames", 2), quick=True)


class Study:
    """A run of a committed study (bench/studies), small enough for a gate, and how its figures of merit are judged:
    an "error" is worse where it grows, a "value" where it is another."""

    def __init__(self, name, kinds, *overrides):
        self.name, self.kinds, self.overrides = name, kinds, overrides


STUDIES = [
    Study("bar", {"period": "value", "damping": "error"}, "parameters.cells=16"),
    Study("vortex", {"displacement_error": "error"}, "parameters.cells=12"),
    Study("plane_column", {"run_out": "value", "heap": "value"}, "parameters.cells=8"),
    Study("column", {"run_out": "value", "heap": "value"}, "parameters.cells=6"),
]
