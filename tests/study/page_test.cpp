// Repose tests: the page of a study, as text, and in a browser: a script that is put behind it does what a
// reader does and leaves what it saw. Where no Chromium is, that is skipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <json/json.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/study/study_rig.h"

namespace repose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string page() {
  const MadeStudy made;
  const Summary summary = summarize(made.plan, made.runs);
  return made.report(summary).page();
}

TEST(Page, StandsByItself) {
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("<h1>made: accuracy against time</h1>"));
  EXPECT_THAT(html, HasSubstr("physics gave out: particle 7"));
  EXPECT_THAT(html, HasSubstr("refused &lt;for a test&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("refused <for"))) << "nothing of a scene may become a tag";
  for (const char* what : {"src=", "@import", "url(http", "<link"}) EXPECT_THAT(html, Not(HasSubstr(what)));
}

TEST(Page, Data_ReadsBack) {
  const std::string html = page(), begin = "id=\"study-data\">";
  const std::size_t from = html.find(begin) + begin.size();
  std::istringstream text(html.substr(from, html.find("</script>", from) - from));
  Json::Value json;
  std::string errors;
  ASSERT_TRUE(Json::parseFromStream(Json::CharReaderBuilder(), text, &json, &errors)) << errors;
  EXPECT_EQ(json["points"].size(), 7u);
  EXPECT_THAT(json["points"][1]["words"].asString(), HasSubstr("<for a test>"));
}

std::string chromium() {
  for (const char* name : {"chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"}) {
    if (std::system((std::string("command -v ") + name + " >/dev/null 2>&1").c_str()) == 0) return name;
  }
  return "";
}

/// What a reader does; each line of what is seen becomes a line of the result.
constexpr const char* kReader = R"js(
<pre id="seen"></pre>
<script>
const seen = [];
const say = (name, value) => seen.push(name + "=" + value);
const tip = document.getElementById("tip");
const column = (k) => Array.from(document.querySelectorAll("tbody tr")).map((r) => r.cells[k].dataset.sort).join(" ");
const visit = (e, type) => e.dispatchEvent(new PointerEvent(type, {clientX: 20, clientY: 20, bubbles: type === "click"}));
try {
  say("marks", document.querySelectorAll("#run_out figure:first-child .mark").length);
  say("tip at first", tip.hidden);
  const mark = document.querySelector("#run_out .mark[data-point='2']");
  visit(mark, "pointerenter");
  say("tip", tip.textContent.split("\n")[0]);
  say("lit", document.querySelectorAll(".lit").length);
  say("row lit", document.querySelector("tbody tr[data-point='2']").classList.contains("lit"));
  say("curve lit", document.querySelector(".curve[data-point='2']").classList.contains("lit"));
  visit(mark, "pointerleave");
  say("lit after", document.querySelectorAll(".lit").length);
  const time = Array.from(document.querySelectorAll("thead th")).find((h) => h.textContent.startsWith("time"));
  time.querySelector("button").click();
  say("up", column(time.cellIndex));
  time.querySelector("button").click();
  say("down", column(time.cellIndex));
  visit(mark, "click");
  visit(mark, "pointerleave");
  say("pinned", document.querySelectorAll("tr.lit").length);
  document.body.click();
  say("let go", document.querySelectorAll("tr.lit").length);
  let saved = "";
  HTMLAnchorElement.prototype.click = function () { saved = this.download; };
  document.querySelector("figure button").click();
  say("saved", saved);
  say("wide", document.documentElement.scrollWidth <= innerWidth);
} catch (error) { say("error", error); }
document.getElementById("seen").textContent = seen.join("\n");
</script>)js";

class InBrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    browser_ = chromium();
    if (browser_.empty()) GTEST_SKIP() << "no Chromium is installed (Debian: chromium-headless-shell)";
    folder_ = std::filesystem::temp_directory_path() / ("repose_page_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
  }

  /// The page after its scripts, at a width.
  std::string seen(const std::string& html, int width) const {
    const std::string file = (folder_ / "index.html").string();
    std::ofstream(file) << html << kReader;
    const std::string command = browser_ + " --headless --no-sandbox --disable-gpu --user-data-dir='" +
                                (folder_ / "profile").string() + "' --window-size=" + std::to_string(width) +
                                ",900 --virtual-time-budget=3000 --dump-dom 'file://" + file + "' 2>/dev/null";
    FILE* const pipe = popen(command.c_str(), "r");
    std::string text;
    char buffer[4096];
    for (std::size_t read; (read = fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, read);
    EXPECT_EQ(pclose(pipe), 0) << "the browser failed";
    const std::string begin = "<pre id=\"seen\">";
    const std::size_t from = text.find(begin);
    if (from == std::string::npos) return "no page";
    return text.substr(from + begin.size(), text.find("</pre>", from) - from - begin.size()) + "\n";
  }

  std::string browser_;
  std::filesystem::path folder_;
};

TEST_F(InBrowser, HoveringTellsAndTies_HeadingsSort_PlotsAreHandedOut) {
  for (const int width : {1280, 600}) {
    const std::string text = seen(page(), width);
    EXPECT_THAT(text, Not(HasSubstr("error=")));
    EXPECT_THAT(text, HasSubstr("marks=6\n"));
    EXPECT_THAT(text, HasSubstr("tip at first=true\n"));
    EXPECT_THAT(text, HasSubstr("tip=parameters.cells 20, grid.transfer apic\n"));
    EXPECT_THAT(text, HasSubstr("row lit=true\n"));
    EXPECT_THAT(text, HasSubstr("curve lit=true\n"));
    EXPECT_THAT(text, HasSubstr("lit after=0\n"));
    EXPECT_THAT(text, HasSubstr("up=0.101 0.404 0.404 1.616 3 6.592 \n"))
        << "what was refused has no time, and is last";
    EXPECT_THAT(text, HasSubstr("down=6.592 3 1.616 0.404 0.404 0.101 \n"));
    EXPECT_THAT(text, HasSubstr("pinned=1\n"));
    EXPECT_THAT(text, HasSubstr("let go=0\n"));
    EXPECT_THAT(text, HasSubstr("saved=error-run_out.svg\n"));
    EXPECT_THAT(text, HasSubstr("wide=true\n")) << "the page is wider than " << width << " pixels";
  }
}

/// A page whose script is broken must not pass.
TEST_F(InBrowser, WithoutItsScript_IsRejected) {
  std::string html = page();
  const std::size_t from = html.find("\"use strict\"");
  ASSERT_NE(from, std::string::npos);
  html.replace(from, 12, "throw 1;");
  EXPECT_THAT(seen(html, 1280), Not(HasSubstr("row lit=true")));
}

}  // namespace
}  // namespace repose
