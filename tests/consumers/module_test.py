# The Python module as a program uses it: arrays that are the engine's, errors, callbacks and the interpreter's lock.
import inspect, sys, threading, time

import numpy as np
import repose

SCENE = """{"repose": 1, "name": "box", "grid": {"spacing": 0.03125}, "time": {"frames_per_second": 48},
  "materials": {"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": 3.5e5, "poisson_ratio": 0.3,
                         "friction_angle": 35}},
  "bodies": [{"name": "box", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0.03125, 0], "upper": [0.125, 0.15625, 0.125]}}],
  "emitters": [{"name": "hand", "type": "host", "material": "sand"}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.4},
                {"name": "wall", "shape": {"type": "box", "lower": [-0.2, -0.1, -0.3], "upper": [-0.03, 0.4, 0.3]}}]}"""


def engine(**options):
    return repose.Engine(repose.Scene.from_text(SCENE).lead_pose("wall"), threads=1, **options)


def refused(call, status):
    try:
        call()
    except repose.Error as error:
        assert error.status == status, (error.status, str(error))
        return error
    raise AssertionError("it was not refused")


# The engine's own numbers.
one = engine(log_contacts=True)
one.advance_frame()
points = one.points(attributes=["stress", "speed"], mass=True)
ids, x_velocity = one.view(0, "id"), one.view(0, "velocity.x")
assert not ids.flags.owndata and not ids.flags.writeable and ids.dtype == np.uint32
address = x_velocity.__array_interface__["data"][0]
assert address == one.view(0, "velocity.x").__array_interface__["data"][0], "a view copies"
assert np.array_equal(points["v"][ids, 0], x_velocity)
assert points["stress"].shape == (512, 6) and points["P"].dtype == np.float64
assert np.all(np.diff(points["id"].astype(np.int64)) == 1)
generation = one.info.generation
turned = one.points(up="z")["P"]
assert np.array_equal(turned[:, 2], points["P"][:, 1]) and one.info.generation == generation
assert one.sets()[0]["count"] == 512 and "strain.xy" in one.sets()[0]["channels"]
one.advance_step()
assert one.info.generation != generation

# Bits: a state, and what it goes on to.
two = engine()
two.restore(one.state())
assert two.advance_frame().complete and one.advance_frame().complete
assert two.hash == one.hash

# What a host does.
first = one.add_particles("hand", [[0.05, 0.3, 0.05], [0.06, 0.3, 0.05]], [[0, -1, 0]] * 2)
assert first == 512 and one.remove_particles([first]) == 1 and one.info.particles == 513
pose = np.eye(4)
for frame in range(4):
    pose[0, 3] = 0.02 * (frame + 1)
    one.move_collider("wall", pose, 1 / 48)
    one.advance_frame()
assert one.contact("wall")["force"][0] < 0
one.change("gravity.acceleration", [0, 0, 0])
one.advance_seconds(0.5 / 48)

# Numbers of the host's own, and copies as it wants them.
own = repose.Engine(repose.Scene.from_text(SCENE).set("channels", [{"name": "Cd", "components": 3}, {"name": "grain"}]),
                    threads=1)
colours = np.arange(6).reshape(2, 3)
own.add_particles("hand", [[0.05, 0.3, 0.05], [0.06, 0.3, 0.05]], channels={"Cd": colours, "grain": [7, 8]})
assert own.set_values("Cd", [3, 99999], [[1, 2, 3], [4, 5, 6]]) == 1
for asked in (["Cd", "grain"], ["channels"]):
    kept = own.points(attributes=asked)
    assert np.array_equal(kept["Cd"][[3, 512, 513]], [[1, 2, 3], [0, 1, 2], [3, 4, 5]])
    assert np.array_equal(kept["grain"][-2:], [7, 8])
halves = own.points(attributes=["Cd", "pressure"], half=True)
assert halves["v"].dtype == np.float16 and np.array_equal(halves["Cd"][513], [3, 4, 5]) and halves["P"].dtype == np.float64
refused(lambda: own.add_particles("hand", [[0, 1, 0]], channels={"Cd": [1, 2]}), 101)
refused(lambda: own.add_particles("hand", [[0, 1, 0]], channels={"Ce": [1]}), 64)
fog, surface = own.fog(0.02), own.surface()
assert fog["v"].shape == fog["density"].shape + (3,) and surface["surface"].min() < 0 < surface["surface"].max()
mass = fog["density"].sum(dtype=np.float64) * np.prod(fog["voxel"])
assert abs(mass - sum(s["particle_mass"] * s["count"] for s in own.sets())) < 1e-4 * mass
heights = fog["lower"][1] + fog["voxel"][1] * np.arange(fog["density"].shape[1])
middle = (fog["density"].sum(axis=(0, 2)) * heights).sum() / fog["density"].sum()
assert abs(middle - own.points()["P"][:, 1].mean()) < 1e-3

# A wall whose surface runs, and one that does so no more.
one.drive_collider("wall", velocity=[0, 0.5, 0], spin=[0, 0, 0.25], center=[0, 0, 0])
one.advance_step()
one.drive_collider("wall")
refused(lambda: one.drive_collider("floor", velocity=[1, 0, 0]), 64)

# Errors, with key and place.
error = refused(lambda: repose.Scene.from_text(SCENE).set("grid.spacing", -1).check(), 65)
assert error.key == "grid.spacing" and "grid.spacing" in str(error)
refused(lambda: repose.Scene.from_file("/no/such/file"), 66)
refused(lambda: one.move_collider("floor", pose, 1), 64)
refused(lambda: one.view(0, "nothing"), 64)
for wrong in (lambda: one.move_collider("wall", np.eye(3), 1), lambda: one.add_particles("hand", [1, 2, 3])):
    try:
        wrong()
        raise AssertionError("a wrong shape was taken")
    except ValueError:
        pass

# Callbacks, and an exception of one.
seen = []
one.on_progress(lambda progress: seen.append(progress.step) or len(seen) < 3)
assert not one.advance_frame().complete and len(seen) == 3


def fails(progress):
    raise KeyError("of the host")


one.on_progress(fails)
try:
    one.advance_frame()
    raise AssertionError("the exception of a callback was lost")
except KeyError:
    pass
one.on_progress(None)

# Another thread runs, and interrupts, while the library works: the lock is free.
slow = repose.Engine(repose.Scene.from_text(SCENE).set("grid.spacing", 0.008).lead_pose("wall"), threads=1)
told = threading.Event()
slow.on_progress(lambda progress: told.set())
canceller = threading.Thread(target=lambda: (told.wait(), slow.interrupt()))
canceller.start()
report = slow.advance_frame()
canceller.join()
assert not report.complete and report.frame == 0

# Everything says what it does.
for kind in (repose.Scene, repose.Engine):
    for name, member in inspect.getmembers(kind):
        if not name.startswith("_") and callable(member):
            assert member.__doc__, f"{kind.__name__}.{name} has no text"
print("module", repose.__version__, "on", sys.version.split()[0])
