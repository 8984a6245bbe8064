"""Faults that the gate is there to notice, for faults.py: what a person could put in by mistake, the cases that are
measured, and the figure that must tell of it. `find` stands in `file` exactly once."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Fault:
    name: str
    what: str
    file: str
    find: str
    replace: str
    cases: str  # of --only
    told: str  # what matches the line that tells of it
    paired: bool = False  # it takes time and no instructions: two builds are timed in pairs


FAULTS = [
    Fault("instructions", "2 % more instructions in one kernel, which moves particles",
          "kernels/pass/particles.cpp",
          "    speed = max(speed, square);\n    steepest = max(steepest, entries);\n",
          "    speed = max(speed, square);\n    steepest = max(steepest, entries);\n    asm volatile(\"nop\\nnop\");\n",
          "bare", r"^worse .*instructions of .*advance"),
    Fault("delay", "5 % more time, by a loop that waits",
          "engine/step/stepper.cpp",
          "  const CleanFloatingPoint clean;\n  StepReport report;\n",
          """  const CleanFloatingPoint clean;
  struct Wait {
    static double now() {
      timespec time;
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
      return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
    }
    double begun = now();
    ~Wait() {
      const double took = now() - begun;
      while (now() - begun < 1.05 * took) {}
    }
  } wait;
  StepReport report;
""",
          "bare", r"^\| bare \|.*\| slower \|", paired=True),
    Fault("allocation", "one allocation a step",
          "engine/step/stepper.cpp",
          "  const CleanFloatingPoint clean;\n  StepReport report;\n",
          "  const CleanFloatingPoint clean;\n  StepReport report;\n  delete[] new volatile char[64];\n"
          "  std::vector<char> extra(64);\n  asm volatile(\"\" ::\"r\"(extra.data()) : \"memory\");\n",
          "bare", r"^worse .*heap allocations per step"),
    Fault("tolerance", "implicit steps are solved ten times less well",
          "engine/plan/implicit_settings.h",
          "  double tolerance = 3e-2;", "  double tolerance = 3e-1;",
          "implicit projected", r"^worse .*iterations of a frame"),
    Fault("error", "an error that is an eighth larger, of a material that is 1 % too soft",
          "kernels/material/neo_hookean.h",
          "      : mu(static_cast<Real>(p.elasticity.mu())),", "      : mu(static_cast<Real>(0.99 * p.elasticity.mu())),",
          "study vortex", r"^worse .*displacement_error"),
    Fault("bytes", "4 bytes more per particle",
          "engine/effect/age.h",
          "    return enabled ? std::vector", "    return true ? std::vector",
          "bare", r"^worse .*bytes per particle"),
    Fault("pass", "a pass more in a scene that did not ask for it",
          "engine/effect/volume_correction.cpp",
          "                [](Fields&) {});\n",
          "                [](Fields&) {});\n  enabled = true;\n",
          "bare", r"^worse .*instructions per step"),
]
