#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "apps/online/source/line_queue.h"

namespace loopgrid {

/// Recognises lines that a sender sends again after a session was resumed, so that no line counts
/// twice. The sender may begin at any line. The first well-formed laser line of the stream is
/// searched for in the journal. If the stream begins like the session, it is taken to be there.
/// Else it is at the latest place from which all lines are equal up to the journal's end; else
/// where the most lines are equal. From there stream and journal are compared line by line. A line
/// that differs, or comes after the journal's end, is new. If the journal does not have the first
/// laser line, all lines are new. If a log repeats lines, repeated lines may be passed over or
/// taken twice. Lines that differ from all others never are.
class ResumeFilter {
 public:
  using PassOn = std::function<void(ReceivedLine)>;

  /// At most this much is held until the first laser line shows where the stream begins.
  static constexpr std::size_t kMaxHeldBytes = std::size_t{8} << 20;

  /// Takes the journal's next line. Lines of earlier sessions are left out, because they are not
  /// sent again.
  void AddJournalLine(const ReceivedLine& line);

  /// Takes the stream's next line. Calls `pass_on` for lines that are new.
  void Add(ReceivedLine line, const PassOn& pass_on);

  /// Call at the end of the stream.
  void End(const PassOn& pass_on);

  /// Number of lines not passed on so far because the journal has them.
  std::int64_t known_lines() const { return known_lines_; }

  /// Whether all later lines are new. The filter then holds no lines.
  bool done() const { return state_ == State::kDone; }

 private:
  enum class State { kHolding, kComparing, kDone };
  using Hash = std::uint64_t;

  void Locate(Hash laser_line);
  void Compare(ReceivedLine line, const PassOn& pass_on);
  bool MoveToNextPlace(Hash line);
  std::size_t HeldBefore(std::size_t place) const;
  std::size_t HeldAtEnd() const;
  bool HeldIsKnown() const;
  void Finish(std::size_t first_new, std::size_t last_new, const PassOn& pass_on);
  void Settle(const PassOn& pass_on);

  State state_ = State::kHolding;
  std::vector<Hash> journal_;
  std::size_t after_laser_ = 0;  // index in the journal after its last laser line

  std::vector<ReceivedLine> held_;  // of the stream, before its first laser line
  std::vector<Hash> held_hashes_;
  std::size_t held_bytes_ = 0;

  std::vector<std::size_t> places_;  // where the first laser line may be, the likeliest first
  std::size_t place_ = 0;            // index of the one that is being tried
  std::size_t alike_ = 0;            // lines compared so far, the first laser line included
  std::int64_t known_lines_ = 0;
};

}  // namespace loopgrid
