#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace loopgrid {

/// The latest content of the output files that are refreshed while mapping, for any thread to read.
class PublishedFiles {
 public:
  void Put(const std::string& name, std::shared_ptr<const std::string> content) {
    const std::lock_guard lock(mutex_);
    files_[name] = std::move(content);
  }

  /// Null if there is none yet.
  std::shared_ptr<const std::string> Get(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    const auto found = files_.find(name);
    return found == files_.end() ? nullptr : found->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const std::string>> files_;
};

}  // namespace loopgrid
