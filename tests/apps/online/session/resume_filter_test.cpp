#include "apps/online/session/resume_filter.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/support/portable_random.h"

namespace loopgrid {
namespace {

using test_support::PortableRandom;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Lines = std::vector<std::string>;

Lines Slice(const Lines& lines, std::size_t from, std::size_t to) {
  return {lines.begin() + static_cast<std::ptrdiff_t>(from),
          lines.begin() + static_cast<std::ptrdiff_t>(to)};
}

Lines operator+(Lines a, const Lines& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// The lines that the filter passes on.
Lines NewLines(const Lines& journal, const Lines& stream) {
  ResumeFilter filter;
  for (const std::string& line : journal) filter.AddJournalLine({.text = line});
  Lines passed;
  const auto pass_on = [&passed](const ReceivedLine& line) { passed.push_back(line.text); };
  for (const std::string& line : stream) filter.Add({.text = line}, pass_on);
  filter.End(pass_on);
  EXPECT_TRUE(filter.done());
  EXPECT_EQ(filter.known_lines(), std::ssize(stream) - std::ssize(passed));
  return passed;
}

std::string Laser(int number) { return fmt::format("FLASER 1 5 0 0 0 0 0 0 {0} h {0}", number); }

bool IsLaserText(const std::string& line) { return line.starts_with("FLASER 1 5"); }

std::size_t CommonPrefix(const Lines& a, std::size_t a_begin, const Lines& b, std::size_t b_begin) {
  std::size_t count = 0;
  while (a_begin + count < a.size() && b_begin + count < b.size() &&
         a[a_begin + count] == b[b_begin + count]) {
    ++count;
  }
  return count;
}

/// Computes the same from the description of the class, with the whole stream at once.
class Oracle {
 public:
  Oracle(const Lines& journal, const Lines& stream) : journal_(journal), stream_(stream) {
    while (first_ < stream_.size() && !IsLaserText(stream_[first_])) ++first_;
  }

  Lines NewLines() const {
    const std::vector<std::size_t> places = Places();
    if (places.empty()) return Slice(stream_, KnownHead(), stream_.size());
    std::size_t best = places.front();
    for (const std::size_t place : places) {
      if (IsWhole(best)) break;
      if (Alike(place) > Alike(best)) best = place;
    }
    return Slice(stream_, 0, first_ - Aligned(best)) +
           Slice(stream_, first_ + Alike(best), stream_.size());
  }

 private:
  std::size_t Alike(std::size_t place) const {
    return CommonPrefix(journal_, place, stream_, first_);
  }
  bool IsWhole(std::size_t place) const {
    return place + Alike(place) == journal_.size() || first_ + Alike(place) == stream_.size();
  }
  std::size_t Aligned(std::size_t place) const {
    std::size_t count = 0;
    while (count < first_ && count < place &&
           stream_[first_ - 1 - count] == journal_[place - 1 - count]) {
      ++count;
    }
    return count;
  }

  std::vector<std::size_t> Places() const {
    std::vector<std::size_t> places;
    if (first_ == stream_.size()) return places;
    const auto add_if = [&](const auto& wanted) {
      for (std::size_t place = journal_.size(); place-- > 0;) {
        if (journal_[place] == stream_[first_] && wanted(place)) places.push_back(place);
      }
    };
    const auto all_held = [&](std::size_t place) { return Aligned(place) == first_; };
    add_if([&](std::size_t place) { return all_held(place) && place == first_; });
    add_if([&](std::size_t place) { return all_held(place) && place != first_; });
    add_if([&](std::size_t place) { return !all_held(place); });
    return places;
  }

  std::size_t KnownHead() const {
    if (first_ == stream_.size()) {
      for (std::size_t place = 0; place < journal_.size(); ++place) {
        if (CommonPrefix(journal_, place, stream_, 0) == stream_.size()) return stream_.size();
      }
    }
    std::size_t last_laser = journal_.size();
    while (last_laser > 0 && !IsLaserText(journal_[last_laser - 1])) --last_laser;
    for (std::size_t place = last_laser; place < journal_.size(); ++place) {
      const std::size_t length = journal_.size() - place;
      if (length <= first_ && CommonPrefix(journal_, place, stream_, 0) >= length) return length;
    }
    return 0;
  }

  Lines journal_;
  Lines stream_;
  std::size_t first_ = 0;  // of the stream's laser lines
};

/// A log with a header, odometry, and laser lines that are all different.
Lines DistinctLog(int scans) {
  Lines lines = {"# header", "PARAM a 1", "", ""};
  for (int i = 0; i < scans; ++i) {
    lines.push_back("ODOM " + std::to_string(i / 2));
    lines.push_back(Laser(i));
    if (i % 3 == 1) lines.push_back("FLASER 3 1 2");
  }
  return lines;
}

TEST(ResumeFilter, EveryCutOfALogWithDistinctScansIsJoinedWithoutASeam) {
  const Lines log = DistinctLog(7);
  for (std::size_t end = 0; end <= log.size(); ++end) {
    const Lines journal = Slice(log, 0, end);
    EXPECT_EQ(journal + NewLines(journal, log), log) << end;
    for (std::size_t begin = 0; begin <= end; ++begin) {
      const Lines stream = Slice(log, begin, log.size());
      // A sender knows which scans were acknowledged, but not which other lines.
      if (begin > 0 && !IsLaserText(log[begin - 1])) continue;
      EXPECT_EQ(journal + NewLines(journal, stream), log) << begin << " to " << end;
    }
  }
}

TEST(ResumeFilter, StreamThatEndsWithinTheJournalBringsNothingNew) {
  const Lines log = DistinctLog(7);
  for (std::size_t end = 0; end <= log.size(); ++end) {
    EXPECT_THAT(NewLines(log, Slice(log, 0, end)), IsEmpty()) << end;
  }
}

TEST(ResumeFilter, LogOfARobotThatStandsStillIsSentAgainWithoutASeam) {
  const Lines still = {"# header", Laser(1), Laser(1), Laser(1), Laser(2),
                       Laser(2),   "ODOM 2", Laser(2), Laser(3), Laser(3)};
  for (std::size_t end = 0; end <= still.size(); ++end) {
    const Lines journal = Slice(still, 0, end);
    EXPECT_EQ(journal + NewLines(journal, still), still) << end;
  }
}

TEST(ResumeFilter, CutsOfRepeatingLogsDifferAtMostInHowOftenALineRepeats) {
  PortableRandom random(3);
  for (int round = 0; round < 2000; ++round) {
    Lines log;
    for (int i = 0; i < 6; ++i) {
      const auto times = 1 + random.Index(3);
      log.insert(log.end(), times, Laser(i));
    }
    const auto end = random.Index(log.size() + 1);
    const auto begin = random.Index(end + 1);
    const Lines journal = Slice(log, 0, end);
    Lines joined = journal + NewLines(journal, Slice(log, begin, log.size()));
    for (Lines* lines : {&log, &joined}) {
      lines->erase(std::unique(lines->begin(), lines->end()), lines->end());
    }
    ASSERT_EQ(joined, log) << "round " << round << ": " << begin << " to " << end;
  }
}

TEST(ResumeFilter, DecidesAsDescribedWhateverTheLines) {
  PortableRandom random(4);
  const Lines words = {Laser(1), Laser(2), Laser(3), "ODOM", "#", "FLASER 3 1 2"};
  const auto random_lines = [&] {
    Lines lines(random.Index(12));
    for (std::string& line : lines) {
      line = words[random.Index(words.size())];
    }
    return lines;
  };
  for (int round = 0; round < 30'000; ++round) {
    const Lines journal = random_lines();
    Lines stream = random_lines();
    // Most streams contain lines of the journal.
    if (random.Uniform() < 0.8) {
      const auto begin = random.Index(journal.size() + 1);
      stream = Slice(journal, begin, journal.size()) + stream;
    }
    ASSERT_EQ(NewLines(journal, stream), Oracle(journal, stream).NewLines())
        << "round " << round << "\n"
        << ::testing::PrintToString(journal) << "\n"
        << ::testing::PrintToString(stream);
  }
}

TEST(ResumeFilter, LinesOfEarlierSessionsAreNotLookedUp) {
  const Lines log = DistinctLog(5);
  const Lines mark = {"# loopgrid new-session"};
  EXPECT_EQ(NewLines(log + mark, log), log);
  const Lines begun = Slice(log, 0, 8);
  EXPECT_EQ(NewLines(log + mark + begun, log), Slice(log, 8, log.size()));
}

TEST(ResumeFilter, HeaderThatIsNotInTheJournalIsNew) {
  EXPECT_THAT(NewLines({"# a", Laser(1), Laser(2)}, {"# b", Laser(2), Laser(3)}),
              ElementsAre("# b", Laser(3)));
}

TEST(ResumeFilter, LinesThatAreTooLongAreKnownAgain) {
  ResumeFilter filter;
  filter.AddJournalLine({.text = "", .too_long = true});
  filter.AddJournalLine({.text = Laser(1)});
  const auto pass_on = [](const ReceivedLine& line) { ADD_FAILURE() << line.text; };
  filter.Add({.text = "", .too_long = true}, pass_on);
  filter.Add({.text = Laser(1)}, pass_on);
  EXPECT_TRUE(filter.done());
  EXPECT_EQ(filter.known_lines(), 2);
}

TEST(ResumeFilter, HoldsNoMoreThanItMay) {
  ResumeFilter filter;
  filter.AddJournalLine({.text = Laser(1)});
  std::size_t given = 0;
  std::size_t passed = 0;
  const auto pass_on = [&passed](const ReceivedLine&) { ++passed; };
  while (!filter.done()) {
    ASSERT_LT(given * 1000, 2 * ResumeFilter::kMaxHeldBytes);
    filter.Add({.text = std::string(1000, 'x')}, pass_on);
    ++given;
  }
  EXPECT_EQ(passed, given);
  filter.Add({.text = Laser(1)}, pass_on);
  EXPECT_EQ(passed, given + 1);
}

}  // namespace
}  // namespace loopgrid
