#include "apps/online/session/session_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "apps/output/json_reader.h"
#include "apps/output/json_writer.h"
#include "apps/output/session_names.h"
#include "apps/settings/mapping_options.h"
#include "backend/base/atomic_file.h"
#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "frontend/log/carmen/carmen_interpreter.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;

std::string FormatSession(const SessionRequest& options) {
  JsonWriter json(JsonWriter::Layout::kIndented);
  json.BeginObject().Field("program", "loopgrid").Field("version", LOOPGRID_VERSION);
  AddMappingFields(options.run, &json);
  json.Field("continues", options.continued).EndObject();
  return json.Take() + '\n';
}

template <typename Value>
void Adopt(const MappingOption& option, const Value& stored, const SessionRequest& options,
           Value* value) {
  if (options.given.contains(option.key) && *value != stored) {
    throw Error(ErrorCode::kUsage, fmt::format("{} is {}, but the session in {} was begun with {}",
                                               option.name, *value, options.resume, stored));
  }
  *value = stored;
}

/// Whether a folder has a file of this name. Throws Error (kInput) if the folder cannot be read.
bool Exists(const std::string& folder, const char* name) {
  std::error_code error;
  const fs::file_status status = fs::status(folder + "/" + name, error);
  if (status.type() == fs::file_type::not_found) return false;
  if (!error) return true;
  throw Error(ErrorCode::kInput, fmt::format("{}: cannot be read: {}", folder, error.message()));
}

/// The file with the lines of another session or run.
std::string LinesOf(const std::string& folder) {
  for (const char* name : {kJournalName, "corrected.clf"}) {
    if (Exists(folder, name)) return folder + "/" + name;
  }
  throw Error(ErrorCode::kInput, folder + ": holds no journal.clf and no corrected.clf");
}

}  // namespace

SessionFolder::SessionFolder(SessionRequest* options, OutputDirectory* outputs)
    : path_(options->run.out) {
  const bool resumed = !options->resume.empty();
  if (resumed && !Exists(path_, kSessionName)) {
    throw Error(ErrorCode::kInput, path_ + ": holds no session to resume");
  }
  outputs->Prepare();
  if (resumed) {
    Resume(options);
  } else {
    Begin(*options);
  }
  if (!options->continued.empty() && !Exists(path_, kJournalName)) {
    try {
      CopyJournalOf(options->continued);
    } catch (...) {
      std::error_code ignored;
      if (!resumed) fs::remove(File(kSessionName), ignored);
      throw;
    }
  }
  journal_ = std::make_unique<Journal>(File(kJournalName));
  options->run.log = journal_->path();
}

SessionFolder::~SessionFolder() {
  if (journal_ == nullptr || !journal_->empty()) return;
  std::error_code ignored;
  fs::remove(File(kJournalName), ignored);
  fs::remove(File(kSessionName), ignored);
}

void SessionFolder::Begin(const SessionRequest& options) const {
  std::error_code ignored;
  if (fs::exists(File(kJournalName), ignored) && fs::file_size(File(kJournalName), ignored) > 0) {
    throw Error(ErrorCode::kOutput,
                fmt::format("{}: holds a session already: go on with it (--resume {}), or choose "
                            "another folder",
                            path_, path_));
  }
  fs::remove(File(kJournalName), ignored);
  if (!options.continued.empty()) LinesOf(options.continued);
  // Comes first: a folder with a journal can be resumed.
  WriteFileAtomically(File(kSessionName), FormatSession(options));
}

void SessionFolder::Resume(SessionRequest* options) const {
  const JsonMembers session(File(kSessionName));
  for (const MappingOption& option : MappingOptions()) {
    if (option.number == nullptr) {
      Adopt(option, session.Switch(option.key), *options, &option.flag(options->run));
    } else {
      Adopt(option, session.Number(option.key), *options, &option.number(options->run));
    }
  }
  options->continued = session.Text("continues");
  options->run.Validate();
}

void SessionFolder::CopyJournalOf(const std::string& other) const {
  LineReader lines(LinesOf(other));
  AtomicFile copy(File(kJournalName));
  ReceivedLine line;
  std::string_view text;
  while (lines.Next(&text)) {
    line.text = lines.terminated() ? text : WithoutCutField(text);
    line.too_long = lines.too_long();
    copy.Append(JournalText(line) + '\n');
  }
  copy.Append(fmt::format("{}\n", kNewSessionLine));
  copy.Commit();
}

}  // namespace loopgrid
