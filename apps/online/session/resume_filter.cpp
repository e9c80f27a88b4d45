#include "apps/online/session/resume_filter.h"

#include <algorithm>
#include <utility>

#include "frontend/log/carmen/carmen_interpreter.h"
#include "frontend/log/carmen/carmen_line.h"

namespace loopgrid {
namespace {

std::uint64_t HashOf(const ReceivedLine& line) {
  constexpr std::uint64_t kTooLong = 1;
  return line.too_long ? kTooLong : std::hash<std::string_view>()(line.text);
}

/// Whether it is a well-formed laser line. Malformed lines may repeat, so they cannot show a place.
bool IsLaserLine(const ReceivedLine& line) {
  CarmenLaserMessage ignored;
  return IsLaser(TagOf(line.text)) && ParseLaserLine(line.text, &ignored).empty();
}

}  // namespace

void ResumeFilter::AddJournalLine(const ReceivedLine& line) {
  if (line.text == kNewSessionLine) {
    journal_.clear();
    after_laser_ = 0;
    return;
  }
  journal_.push_back(HashOf(line));
  if (IsLaserLine(line)) after_laser_ = journal_.size();
}

void ResumeFilter::Add(ReceivedLine line, const PassOn& pass_on) {
  if (state_ == State::kComparing) {
    Compare(std::move(line), pass_on);
  } else if (state_ == State::kDone) {
    pass_on(std::move(line));
  } else if (IsLaserLine(line)) {
    Locate(HashOf(line));
    if (places_.empty()) {
      Finish(HeldAtEnd(), held_.size(), pass_on);
      pass_on(std::move(line));
    } else {
      state_ = State::kComparing;
      if (places_.front() + 1 == journal_.size()) Settle(pass_on);
    }
  } else {
    held_bytes_ += line.text.size() + sizeof(ReceivedLine);
    held_hashes_.push_back(HashOf(line));
    held_.push_back(std::move(line));
    if (held_bytes_ > kMaxHeldBytes) Finish(HeldAtEnd(), held_.size(), pass_on);
  }
}

void ResumeFilter::End(const PassOn& pass_on) {
  if (state_ == State::kComparing) Settle(pass_on);
  if (state_ == State::kHolding) {
    Finish(HeldIsKnown() ? held_.size() : HeldAtEnd(), held_.size(), pass_on);
  }
}

/// Fills `places_`. First comes the beginning of the session, if the stream begins in the same way.
/// Then come the places that all held lines stand before, then the others; in both groups the
/// latest come first.
void ResumeFilter::Locate(Hash laser_line) {
  std::vector<std::size_t> unlike;
  for (std::size_t place = journal_.size(); place-- > 0;) {
    if (journal_[place] != laser_line) continue;
    (HeldBefore(place) == held_.size() ? places_ : unlike).push_back(place);
  }
  if (!places_.empty() && places_.back() == held_.size()) {
    std::rotate(places_.begin(), places_.end() - 1, places_.end());
  }
  places_.insert(places_.end(), unlike.begin(), unlike.end());
  place_ = 0;
  alike_ = 1;
}

void ResumeFilter::Compare(ReceivedLine line, const PassOn& pass_on) {
  const Hash hash = HashOf(line);
  const std::size_t next = places_[place_] + alike_;
  if (journal_[next] != hash && !MoveToNextPlace(hash)) {
    Settle(pass_on);
    pass_on(std::move(line));
    return;
  }
  ++alike_;
  if (places_[place_] + alike_ == journal_.size()) Settle(pass_on);
}

/// Moves to the next place from which the journal has the same lines as the stream so far, with
/// `line`.
bool ResumeFilter::MoveToNextPlace(Hash line) {
  const auto begin = journal_.begin() + static_cast<std::ptrdiff_t>(places_[place_]);
  const auto end = begin + static_cast<std::ptrdiff_t>(alike_);
  for (std::size_t i = place_ + 1; i < places_.size(); ++i) {
    if (places_[i] + alike_ >= journal_.size() || journal_[places_[i] + alike_] != line) continue;
    if (!std::equal(begin, end, journal_.begin() + static_cast<std::ptrdiff_t>(places_[i]))) {
      continue;
    }
    place_ = i;
    return true;
  }
  return false;
}

/// Number of held lines, counted back from the last one, that the journal has right before `place`.
std::size_t ResumeFilter::HeldBefore(std::size_t place) const {
  std::size_t count = 0;
  while (count < held_.size() && count < place &&
         held_hashes_[held_.size() - 1 - count] == journal_[place - 1 - count]) {
    ++count;
  }
  return count;
}

/// Number of held lines, counted from the first one, with which the journal ends.
std::size_t ResumeFilter::HeldAtEnd() const {
  std::size_t count = std::min(held_.size(), journal_.size() - after_laser_);
  while (!std::equal(held_hashes_.begin(),
                     held_hashes_.begin() + static_cast<std::ptrdiff_t>(count),
                     journal_.end() - static_cast<std::ptrdiff_t>(count))) {
    --count;
  }
  return count;
}

/// Whether the journal has all the held lines in a row.
bool ResumeFilter::HeldIsKnown() const {
  return std::search(journal_.begin(), journal_.end(), held_hashes_.begin(), held_hashes_.end()) !=
         journal_.end();
}

/// Called when the place is found. Held lines that the journal does not have before it are new.
void ResumeFilter::Settle(const PassOn& pass_on) {
  const std::size_t count_new = held_.size() - HeldBefore(places_[place_]);
  known_lines_ += static_cast<std::int64_t>(alike_ + held_.size() - count_new);
  held_.resize(count_new);
  Finish(0, count_new, pass_on);
}

/// Passes on the held lines in this range and ends the search. All later lines are new.
void ResumeFilter::Finish(std::size_t first_new, std::size_t last_new, const PassOn& pass_on) {
  state_ = State::kDone;
  known_lines_ += static_cast<std::int64_t>(first_new);
  journal_ = {};
  places_ = {};
  held_hashes_ = {};
  const std::vector<ReceivedLine> held = std::exchange(held_, {});
  for (std::size_t i = first_new; i < last_new; ++i) pass_on(held[i]);
}

}  // namespace loopgrid
