#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "apps/online/source/line_queue.h"

namespace loopgrid {

/// Knows again what a sender sends once more after a session was resumed, from the beginning or
/// from anywhere, so that no line counts twice. The first well-formed laser line of the stream is
/// looked up among the journal's: at the same place if the stream begins like the session, else the
/// latest place from where the lines go on alike to the journal's end, else where they stay alike
/// longest. From there stream and journal are compared line by line; what differs or lies beyond is
/// new, and so is everything if the first laser line is. Lines that a log repeats within what was
/// sent twice may thus be passed over or doubled; distinct ones never are.
class ResumeFilter {
 public:
  using PassOn = std::function<void(ReceivedLine)>;

  /// At most so much is held until the first laser line shows where the stream begins.
  static constexpr std::size_t kMaxHeldBytes = std::size_t{8} << 20;

  /// The journal's next line. Lines of earlier sessions in it are forgotten: nobody sends them.
  void AddJournalLine(const ReceivedLine& line);

  /// The stream's next line; calls `pass_on` for lines that are new.
  void Add(ReceivedLine line, const PassOn& pass_on);

  /// The stream is over.
  void End(const PassOn& pass_on);

  /// How many lines were not passed on so far because the journal has them.
  std::int64_t known_lines() const { return known_lines_; }

  /// Whether all that comes is new; nothing is remembered any more.
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
  std::size_t after_laser_ = 0;  // of the journal: behind its last laser line

  std::vector<ReceivedLine> held_;  // of the stream, before its first laser line
  std::vector<Hash> held_hashes_;
  std::size_t held_bytes_ = 0;

  std::vector<std::size_t> places_;  // where the first laser line may be, the likeliest first
  std::size_t place_ = 0;            // index of the one that is being tried
  std::size_t alike_ = 0;            // lines compared so far, the first laser line included
  std::int64_t known_lines_ = 0;
};

}  // namespace loopgrid
