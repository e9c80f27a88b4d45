#pragma once

namespace loopgrid {

// Files of `loopgrid online` in the folder of a session, beside the files of a run.
inline constexpr const char* kJournalName = "journal.clf";   ///< the lines received so far
inline constexpr const char* kSessionName = "session.json";  ///< the options that it was begun with

}  // namespace loopgrid
