// Repose: the style and the script that a page carries within it (page.css, page.js, put into the program when
// it is built).
#pragma once

namespace repose {

extern const char* const kPageStyle;
extern const char* const kPageScript;

}  // namespace repose
