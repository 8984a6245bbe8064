// Repose: the words of implicit_bench: a subcommand per study, and "all".
#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/repose/command.h"
#include "bench/implicit_study.h"

namespace repose {
namespace {

void describe_options(CLI::App& app, ImplicitStudyArguments& arguments, std::string& page) {
  app.add_option("--page", page, "put the tables into this page, docs/implicit.md");
  app.add_option("--modes", arguments.modes, "implicit.mode (default: as the study has it)")->delimiter(',');
  app.add_option("--steps", arguments.steps, "lengths of implicit steps, s (default: as the study has it)")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("--cells", arguments.cells, "cells across what is studied (default: as the study has it)")
      ->check(CLI::Range(2, 1000));
  app.add_option("--until", arguments.until, "seconds of the scene (default: as the study has it)")
      ->check(CLI::PositiveNumber);
  app.add_option("--most-seconds", arguments.most_seconds, "of computing, for one run (default 20)")
      ->check(CLI::PositiveNumber);
  app.add_option("--set", arguments.set, "change every scene, such as implicit.preconditioner=none");
}

/// Puts the study's table into the page, or prints it.
Result<void> tell(const ImplicitStudy& study, const ImplicitStudyArguments& arguments,
                  const std::string& page) {
  std::fprintf(stderr, "%s\n", study.name);
  const auto table = study.run(arguments);
  if (!table) return table.error();
  if (page.empty()) {
    std::printf("%s\n", table->markdown().c_str());
    std::fflush(stdout);
    return {};
  }
  const std::string mark = std::string("<!-- implicit_bench ") + study.name + ": ";
  return put_into(page, {mark + "begin -->\n", mark + "end -->\n"}, table->markdown());
}

int main(int count, char** words) {
  ImplicitStudyArguments arguments;
  std::string page;
  CLI::App app{"The studies of implicit steps behind docs/implicit.md: one thread, seconds of the processor",
               "implicit_bench"};
  app.fallthrough();
  app.require_subcommand(1);
  describe_options(app, arguments, page);
  const CLI::App* all = app.add_subcommand("all", "every study");
  for (const ImplicitStudy& study : studies()) app.add_subcommand(study.name, study.meaning);
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    return status == 0 ? 0 : static_cast<int>(ErrorKind::kUsage);
  }
  for (const ImplicitStudy& study : studies()) {
    if (!all->parsed() && !app.got_subcommand(study.name)) continue;
    if (auto told = tell(study, arguments, page); !told) return fail(told.error());
  }
  return 0;
}

}  // namespace
}  // namespace repose

int main(int count, char** words) {
  return repose::main(count, words);
}
