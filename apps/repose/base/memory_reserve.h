// Repose: room for a good end. Where the system gives no more memory, libraries end the program from within
// destructors; so some is set aside, and given back then: what was under way goes on, and the run sees to its
// end.
#pragma once

namespace repose {

/// Sets the room aside, and has `operator new` ask for it once when it finds no other.
void keep_memory_reserve();
/// Whether it had to be given back.
bool memory_gave_out();

}  // namespace repose
