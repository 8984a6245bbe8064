// Steps the bunny:  bunny SCENE FRAMES
#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <repose/repose.hpp>

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  try {
    repose::Scene scene = repose::Scene::from_file(argv[1]);
    repose::Engine engine(scene);
    for (int frame = 0; frame < std::atoi(argv[2]); ++frame) {
      const repose_report report = engine.advance_frame();
      std::printf("frame %" PRId64 ": %" PRId64 " steps, %.4f s\n", report.frame, report.steps, report.time);
    }

    const repose::Points points = engine.points();
    double lowest = 1e30;
    for (const auto& x : points.positions()) lowest = x[1] < lowest ? x[1] : lowest;
    std::printf("%zu particles, the lowest at %.4f m\n", points.size(), lowest);
    std::printf("state hash %016" PRIx64 "\n", engine.hash());
  } catch (const repose::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.status();
  }
}
