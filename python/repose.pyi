# Types of the module repose. Units are SI: m, s, kg, N, Pa.
from typing import Any, Callable, Mapping, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str

class Error(RuntimeError):
    status: int
    key: str
    place: str

class Scene:
    def __init__(self, folder: str = ".") -> None: ...
    @staticmethod
    def from_file(path: str, quality: str = "standard", allow_outside_paths: bool = False) -> Scene: ...
    @staticmethod
    def from_text(
        text: str,
        folder: str = ".",
        name: str = "scene",
        quality: str = "standard",
        allow_outside_paths: bool = False,
    ) -> Scene: ...
    def set(self, key: str, value: Any) -> Scene: ...
    def check(self) -> None: ...
    def json(self) -> str: ...
    def lead_pose(self, collider: str) -> Scene: ...
    def lead_mesh(self, collider: str, rate: float) -> Scene: ...
    def vdb_reader(self, program: str = "", memory: float = 0.0, seconds: float = 0.0) -> Scene: ...

class Report:
    frame: int
    step: int
    time: float
    steps: int
    least_dt: float
    most_dt: float
    redone: int
    complete: bool
    seconds: float

class Progress:
    frame: int
    step: int
    time: float
    dt: float

class Info:
    frame: int
    step: int
    time: float
    particles: int
    particles_asleep: int
    blocks: int
    generation: int
    memory: float
    threads: int
    implicit: bool
    sound: bool

class Engine:
    info: Info
    hash: int
    warnings: list[str]
    def __init__(
        self,
        scene: Scene,
        threads: int = 0,
        target: str = "best",
        memory_limit: float = 0.0,
        log_contacts: bool = False,
        log: Optional[Callable[[int, str], None]] = None,
    ) -> None: ...
    def advance_frame(self) -> Report: ...
    def advance_seconds(self, seconds: float) -> Report: ...
    def advance_step(self) -> Report: ...
    def interrupt(self) -> None: ...
    def on_progress(self, progress: Optional[Callable[[Progress], Optional[bool]]]) -> None: ...
    def change(self, key: str, value: Any) -> None: ...
    def save(self, path: str) -> None: ...
    def load(self, path: str) -> None: ...
    def state(self) -> bytes: ...
    def restore(self, state: bytes) -> None: ...
    def points(
        self, attributes: Sequence[str] = ..., up: str = "scene", mass: bool = False, half: bool = False
    ) -> dict[str, NDArray[Any]]: ...
    def surface(self, voxel: float = 0.0, radius: float = 0.0, smoothing: int = -1) -> dict[str, Any]: ...
    def fog(self, voxel: float = 0.0) -> dict[str, Any]: ...
    def sets(self) -> list[dict[str, Any]]: ...
    def view(self, set: int, channel: str) -> NDArray[Any]: ...
    def block_corners(self) -> NDArray[np.float64]: ...
    def measurements(self) -> list[tuple[str, str, str, float]]: ...
    def move_collider(self, collider: str, matrix: ArrayLike, seconds: float) -> None: ...
    def deform_collider(
        self, collider: str, vertices: ArrayLike, triangles: Optional[ArrayLike] = None, at_once: bool = False
    ) -> None: ...
    def drive_collider(
        self,
        collider: str,
        velocity: Optional[Sequence[float]] = None,
        spin: Optional[Sequence[float]] = None,
        center: Optional[Sequence[float]] = None,
    ) -> None: ...
    def contact(self, collider: str) -> dict[str, Any]: ...
    def add_particles(
        self,
        emitter: str,
        positions: ArrayLike,
        velocities: Optional[ArrayLike] = None,
        channels: Mapping[str, ArrayLike] = ...,
    ) -> int: ...
    def set_values(self, channel: str, ids: ArrayLike, values: ArrayLike) -> int: ...
    def remove_particles(self, ids: ArrayLike) -> int: ...
