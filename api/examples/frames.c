/* Advances a scene by some frames and prints the hash of its state:  frames SCENE COUNT */
#include <inttypes.h>
#include <repose/repose.h>
#include <stdio.h>
#include <stdlib.h>

static int refused(void) {
  char message[4096];
  repose_error_message(message, sizeof message);
  fprintf(stderr, "%s\n", message);
  return repose_error_status();
}

static int each_step(void* user, const repose_progress* progress) {
  if (progress->step % 50 == 0) fprintf(stderr, "step %" PRId64 ", %.4f s\n", progress->step, progress->time);
  return *(const int*)user; /* not 0 would end the frame here */
}

int main(int argc, char** argv) {
  repose_scene scene;
  repose_engine engine;
  repose_engine_options options = repose_engine_options_init();
  repose_report report = repose_report_init();
  uint64_t hash = 0;
  int stop = 0;
  if (argc != 3) return 64;

  if (repose_scene_from_file(argv[1], NULL, &scene) != REPOSE_OK) return refused();
  options.threads = 2;
  if (repose_engine_create(scene, &options, &engine) != REPOSE_OK) return refused();
  repose_scene_destroy(scene);
  repose_set_progress(engine, each_step, &stop);

  for (int frame = 0; frame < atoi(argv[2]); ++frame) {
    if (repose_advance_frame(engine, &report) != REPOSE_OK) return refused();
    printf("frame %" PRId64 ": %" PRId64 " steps, %.4f s\n", report.frame, report.steps, report.time);
  }
  if (repose_hash(engine, &hash) != REPOSE_OK) return refused();
  printf("state hash %016" PRIx64 "\n", hash);
  repose_engine_destroy(engine);
  return 0;
}
