// Repose: a film, by handing raw pictures to ffmpeg as they come: no folder of pictures, no codec of ours.
#pragma once

#include <sys/types.h>

#include <cstdio>
#include <string>

#include "apps/repose/render/image.h"
#include "engine/base/result.h"

namespace repose {

/// One H.264 film in the making. Destroyed without finish(), it leaves nothing.
class Film {
 public:
  /// Starts ffmpeg. `width` and `height` are even, as H.264's colours want it. `encoder` is the program to run.
  /// Errors: 64 for a size or rate that cannot be; 73 when the folder refuses or ffmpeg is not installed.
  static Result<Film> start(const std::string& path, int width, int height, double frames_per_second,
                            const std::string& encoder = "ffmpeg");

  Film(Film&& other) noexcept;
  Film& operator=(Film&&) = delete;
  ~Film();

  /// Appends a picture of the film's size. Error: 74 with what ffmpeg said, when it has stopped.
  Result<void> add(const Image& image);

  /// Waits for ffmpeg and gives the film its name. Errors: 74 with what ffmpeg said; 73.
  Result<void> finish();

 private:
  Film(std::string path, std::string temporary, int width, int height);
  Result<void> spawn(const std::string& encoder, double frames_per_second);
  int close_and_wait();
  Error failed(const std::string& what);

  std::string path_;
  std::string temporary_;
  int width_;
  int height_;
  int pipe_ = -1;                    // our end
  pid_t process_ = -1;               // ffmpeg
  std::FILE* complaints_ = nullptr;  // what ffmpeg says; a file without a name
};

}  // namespace repose
