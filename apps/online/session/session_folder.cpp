#include "apps/online/session/session_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "apps/output/json_reader.h"
#include "apps/output/json_writer.h"
#include "apps/run/run_outputs.h"
#include "apps/settings/mapping_options.h"
#include "backend/base/atomic_file.h"
#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "frontend/log/carmen/carmen_interpreter.h"

namespace loopgrid {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJournal = "journal.clf";
constexpr const char* kSession = "session.json";

std::string FormatSession(const OnlineOptions& options) {
  JsonWriter json(JsonWriter::Layout::kIndented);
  json.BeginObject().Field("program", "loopgrid").Field("version", LOOPGRID_VERSION);
  AddMappingFields(options.run, &json);
  json.Field("continues", options.continued).EndObject();
  return json.Take() + '\n';
}

template <typename Value>
void Adopt(const MappingOption& option, const Value& stored, const OnlineOptions& options, Value* value) {
  if (options.given.contains(option.key) && *value != stored) {
    throw Error(ErrorCode::kUsage, fmt::format("{} is {}, but the session in {} was begun with {}",
                                               option.name, *value, options.resume, stored));
  }
  *value = stored;
}

bool IsLeftover(const std::string& name) {
  std::vector<std::string> ours = RunOutputNames();
  ours.insert(ours.end(), {kJournal, kSession});
  return name.starts_with(".loopgrid-unfinished-") ||
         std::any_of(ours.begin(), ours.end(), [&name](const std::string& file) {
           return name.starts_with("." + file + ".tmp-");
         });
}

/// What a killed process has left unfinished.
void RemoveLeftovers(const std::string& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    if (IsLeftover(entry.path().filename())) fs::remove_all(entry.path(), ignored);
  }
}

/// The lines that another session, or a run, was made of.
std::string LinesOf(const std::string& folder) {
  for (const char* name : {kJournal, "corrected.clf"}) {
    const std::string path = folder + "/" + name;
    if (fs::exists(path)) return path;
  }
  throw Error(ErrorCode::kInput, folder + ": holds no journal.clf and no corrected.clf");
}

}  // namespace

SessionFolder::SessionFolder(OnlineOptions* options, OutputDirectory* outputs)
    : path_(options->run.out) {
  const bool resumed = !options->resume.empty();
  if (resumed && !fs::exists(File(kSession))) {
    throw Error(ErrorCode::kInput, path_ + ": holds no session to resume");
  }
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) {
    Lock();
    RemoveLeftovers(path_);
    outputs->Prepare();
  } else {
    outputs->Prepare();
    Lock();
  }
  if (resumed) {
    Resume(options);
  } else {
    Begin(*options);
  }
  if (!options->continued.empty() && !fs::exists(File(kJournal))) {
    CopyJournalOf(options->continued);
  }
  journal_ = std::make_unique<Journal>(File(kJournal));
  options->run.log = journal_->path();
}

SessionFolder::~SessionFolder() {
  if (journal_ == nullptr || !journal_->empty()) return;
  std::error_code ignored;
  fs::remove(File(kJournal), ignored);
  fs::remove(File(kSession), ignored);
}

void SessionFolder::Lock() {
  lock_ = Descriptor(open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock_ && flock(lock_.get(), LOCK_EX | LOCK_NB) == 0) return;
  if (errno == EWOULDBLOCK) {
    throw Error(ErrorCode::kOutput, path_ + ": is in use by another process");
  }
  throw Error(ErrorCode::kOutput,
              path_ + ": cannot lock: " + std::generic_category().message(errno));
}

void SessionFolder::Begin(const OnlineOptions& options) const {
  std::error_code ignored;
  if (fs::exists(File(kJournal), ignored) && fs::file_size(File(kJournal), ignored) > 0) {
    throw Error(ErrorCode::kOutput,
                fmt::format("{}: holds a session already: go on with it (--resume {}), or choose "
                            "another folder",
                            path_, path_));
  }
  fs::remove(File(kJournal), ignored);
  if (!options.continued.empty()) LinesOf(options.continued);
  // Comes first: a folder with a journal can be resumed.
  WriteFileAtomically(File(kSession), FormatSession(options));
}

void SessionFolder::Resume(OnlineOptions* options) const {
  const JsonMembers session(File(kSession));
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
  AtomicFile copy(File(kJournal));
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
