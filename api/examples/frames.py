# Advances a scene by some frames and prints the hash of its state:  frames.py SCENE COUNT
import sys

import repose

try:
    engine = repose.Engine(repose.Scene.from_file(sys.argv[1]), threads=2)
    for _ in range(int(sys.argv[2])):
        report = engine.advance_frame()
        print(f"frame {report.frame}: {report.steps} steps, {report.time:.4f} s")
    points = engine.points(attributes=["pressure"])
    print(f"{len(points['id'])} particles, the lowest at {points['P'][:, 1].min():.4f} m")
    print(f"state hash {engine.hash:016x}")
except repose.Error as error:
    sys.exit(f"{error} (status {error.status})")
