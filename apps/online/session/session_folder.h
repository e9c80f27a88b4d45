#pragma once

#include <memory>
#include <set>
#include <string>

#include "apps/online/session/journal.h"
#include "apps/output/output_directory.h"
#include "apps/settings/run_options.h"

namespace loopgrid {

/// The session to begin, to resume or to continue.
struct SessionRequest {
  RunOptions run;         ///< run.out is the session's folder; run.log is set to its journal
  std::string resume;     ///< the folder of a session to go on with; empty: a new one
  std::string continued;  ///< the folder of a session whose map the new one goes on with

  /// Keys of the options on the command line; the others come from a resumed session.
  std::set<std::string> given;
};

/// The folder of a session, locked against other processes. It has the journal, and in session.json
/// the options that the session was begun with.
class SessionFolder {
 public:
  /// Prepares `outputs` (which are in the folder request->run.out). Begins a session, or resumes
  /// the one that is there if request->resume is set; the options that decide its result are then
  /// completed. Sets request->run.log. Throws Error: kOutput if the folder is in use, holds a
  /// session already or cannot be written; kInput if there is none to resume or to continue, or
  /// it cannot be read; kUsage if an option contradicts the resumed session's.
  SessionFolder(SessionRequest* request, OutputDirectory* outputs);

  /// If nothing was received, removes the files of the session.
  ~SessionFolder();
  SessionFolder(const SessionFolder&) = delete;
  SessionFolder& operator=(const SessionFolder&) = delete;

  Journal* journal() { return journal_.get(); }

 private:
  void Begin(const SessionRequest& request) const;
  void Resume(SessionRequest* request) const;
  void CopyJournalOf(const std::string& other) const;
  std::string File(const char* name) const { return path_ + "/" + name; }

  std::string path_;
  std::unique_ptr<Journal> journal_;
};

}  // namespace loopgrid
