#pragma once

#include <memory>
#include <string>

#include "apps/online/online_options.h"
#include "apps/online/session/journal.h"
#include "apps/output/output_directory.h"

namespace loopgrid {

/// The folder of a session, held against other processes: its journal, and what it was started
/// with in session.json.
class SessionFolder {
 public:
  /// Prepares `outputs` (which are in the folder options->run.out). Begins a session, or resumes
  /// the one that is there if options->resume is set; the options that decide its result are then
  /// completed. Sets options->run.log. Throws Error: kOutput if the folder is in use, holds a
  /// session already or cannot be written; kInput if there is none to resume or to continue; kUsage
  /// if an option contradicts the resumed session's.
  SessionFolder(OnlineOptions* options, OutputDirectory* outputs);

  /// Leaves nothing of a session in which nothing was received.
  ~SessionFolder();
  SessionFolder(const SessionFolder&) = delete;
  SessionFolder& operator=(const SessionFolder&) = delete;

  Journal* journal() { return journal_.get(); }

 private:
  void Begin(const OnlineOptions& options) const;
  void Resume(OnlineOptions* options) const;
  void CopyJournalOf(const std::string& other) const;
  std::string File(const char* name) const { return path_ + "/" + name; }

  std::string path_;
  std::unique_ptr<Journal> journal_;
};

}  // namespace loopgrid
