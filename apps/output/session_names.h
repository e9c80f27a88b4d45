#pragma once

namespace loopgrid {

// What `loopgrid online` keeps in the folder of a session beside the files of a run.
inline constexpr const char* kJournalName = "journal.clf";   ///< the lines received so far
inline constexpr const char* kSessionName = "session.json";  ///< what it was begun with

}  // namespace loopgrid
