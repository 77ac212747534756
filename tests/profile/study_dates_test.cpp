#include <gnomon/profile/clock_ranks.h>
#include <gnomon/profile/profile.h>
#include <gnomon/profile/study_dates.h>
#include <gnomon/profile/study_times.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace gnomon {
namespace {

const Place kVienna{48.2 * kDegree, 16.37 * kDegree, 0};
const Place kSvalbard{78.22 * kDegree, 15.65 * kDegree, 0};

std::vector<std::string> dates(const std::string& entry) { return study_dates(entry).value(); }

std::string error(const std::string& entry) {
  const auto found = study_dates(entry);
  return found ? "" : found.error().message;
}

TEST(StudyDates, OneDateIsItself) {
  EXPECT_EQ(dates("2024-02-29"), std::vector<std::string>{"2024-02-29"});
}

TEST(StudyDates, RangeHasBothEndsAndFollowsTheCalendar) {
  EXPECT_EQ(dates("2024-02-27..2024-03-02"),
            (std::vector<std::string>{"2024-02-27", "2024-02-28", "2024-02-29", "2024-03-01",
                                      "2024-03-02"}));
  EXPECT_EQ(dates("2024-03-01..2024-03-01").size(), 1u);
  EXPECT_EQ(dates("0099-12-31..0100-01-01").back(), "0100-01-01");
}

TEST(StudyDates, StepBeginsAtTheFirstDate) {
  EXPECT_EQ(dates("2024-04-01..2024-04-20/7d"),
            (std::vector<std::string>{"2024-04-01", "2024-04-08", "2024-04-15"}));
}

TEST(StudyDates, SayWhatCannotBeRead) {
  for (const char* entry :
       {"2024-04-01..", "..2024-04-01", "2024-04-01..2024-04-31", "2024-04-01...2024-04-30",
        "2024-04-01..2024-04-30/7", "2024-04-01..2024-04-30/0d", "2024-04-01..2024-04-30/-1d",
        "2024-04-01..2024-04-30/d", "2024-04-01..2024-04-30/7d ", "2024-04-01/7d", "April"}) {
    EXPECT_NE(error(entry).find(std::string("'") + entry + "'"), std::string::npos) << entry;
  }
  EXPECT_NE(error("2024-04-02..2024-04-01").find("ends before it begins"), std::string::npos);
  EXPECT_NE(error("2000-01-01..2024-01-01").find("/7d"), std::string::npos);
  EXPECT_EQ(error("2015-01-01..2024-12-31"), "");
  EXPECT_NE(error("").find("--date"), std::string::npos);
}

TEST(StudyRange, IsItsDaysOneAfterTheOther) {
  StudyTimes t{"2024-03-29..2024-04-02", "09:00", "17:00", "90min", "Europe/Vienna"};
  const Samples all = study_samples(t, kVienna, 0.1).value();
  ASSERT_EQ(all.dates.size(), 5u);
  std::size_t at = 0;
  for (std::size_t d = 0; d < all.dates.size(); ++d) {
    t.date = all.dates[d];
    const Samples day = study_samples(t, kVienna, 0.1).value();
    for (const TimeSample& s : day.midpoints) {
      ASSERT_LT(at, all.midpoints.size());
      EXPECT_EQ(all.midpoints[at].utc, s.utc);
      EXPECT_EQ(all.midpoints[at].weight_ms, s.weight_ms);
      EXPECT_EQ(all.midpoints[at].light, s.light);
      EXPECT_EQ(all.midpoints[at].clock_begin_ms, s.clock_begin_ms);
      EXPECT_EQ(all.midpoints[at].day, d);
      ++at;
    }
  }
  EXPECT_EQ(at, all.midpoints.size());
  ASSERT_EQ(all.warnings.size(), 1u) << "the last step is shorter, on each day";
  EXPECT_EQ(all.warnings[0].count, 5u);
  // The clock reads 9:00 on both sides of its change on 31 March; UTC does not.
  EXPECT_EQ(all.midpoints.front().clock_begin_ms, 9 * 3600000);
  EXPECT_EQ(all.midpoints.back().clock_end_ms, 17 * 3600000);
}

TEST(StudyRange, EachDayHasItsOwnSunriseAndSunset) {
  const StudyTimes t{"2024-06-01..2024-12-01/183d", "", "", "1h", "UTC"};
  const Samples s = study_samples(t, kVienna, 0).value();
  ASSERT_EQ(s.dates.size(), 2u);
  std::uint64_t daylight[2] = {0, 0};
  for (const TimeSample& m : s.midpoints) daylight[m.day] += m.weight_ms;
  EXPECT_GT(daylight[0], 15u * 3600000u);
  EXPECT_LT(daylight[1], 9u * 3600000u);
}

TEST(StudyRange, DaysWithoutASunriseCountAsDaysButOnlyAllOfThemAreAnError) {
  StudyTimes t{"2024-02-01..2024-03-01", "", "", "1h", "UTC"};
  const Samples s = study_samples(t, kSvalbard, 0).value();
  EXPECT_EQ(s.dates.size(), 30u);
  const auto night = std::find_if(s.warnings.begin(), s.warnings.end(), [](const Warning& w) {
    return w.what.find("counts as a day without daylight") != std::string::npos;
  });
  ASSERT_NE(night, s.warnings.end());
  EXPECT_EQ(night->first, "2024-02-01");
  EXPECT_GT(night->count, 5u);
  EXPECT_LT(night->count, 25u);
  EXPECT_EQ(s.midpoints.front().day, night->count);
  t.date = "2024-12-01..2024-12-20";
  const auto none = study_samples(t, kSvalbard, 0);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("any day of 2024-12-01..2024-12-20"), std::string::npos);
}

TEST(StudyRange, IsRefusedWhereOneDateIsWanted) {
  const auto w = study_window({"2024-06-01..2024-06-02", "", "", "1h", "UTC"}, kVienna);
  ASSERT_FALSE(w);
  EXPECT_NE(w.error().message.find("one date"), std::string::npos);
}

TEST(StudyRange, TooManyStepsInAllAreRefused) {
  const auto s =
      study_samples({"2024-01-01..2024-01-03", "00:00", "24:00", "2s", "UTC"}, kVienna, 0);
  ASSERT_FALSE(s);
  EXPECT_NE(s.error().message.find("100000"), std::string::npos);
}

TEST(StudyRange, ClockTimesOfADayGoBeyondItsMidnight) {
  const Place reykjavik{64.1466 * kDegree, -21.9426 * kDegree, 0};
  const Samples s =
      study_samples({"2024-06-21", "", "", "1h", "Atlantic/Reykjavik"}, reykjavik, 0).value();
  EXPECT_GT(s.midpoints.back().clock_end_ms, 24 * 3600000);
  const Samples solar =
      study_samples({"2024-06-21", "08:00", "16:00", "1h", "solar"}, kVienna, 0).value();
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_EQ(solar.midpoints[k].clock_begin_ms, static_cast<int>(k + 8) * 3600000);
}

TEST(ClockRanks, KeepOrderAndGiveTheTimesBack) {
  const std::vector<std::int32_t> times{500, -3, 500, 90000000, 0};
  const ClockRanks r = rank_clock_times(times, SharedRank::kEarliest);
  EXPECT_EQ(r.times, (std::vector<std::int32_t>{-3, 0, 500, 90000000}));
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_EQ(r.times[r.ranks[k]], times[k]);
  EXPECT_TRUE(rank_clock_times({}, SharedRank::kLatest).times.empty());
}

TEST(ClockRanks, OfTooManyTimesNeighboursShareTheEarliestOrTheLatest) {
  std::vector<std::int32_t> times(100000);
  std::iota(times.begin(), times.end(), 0);
  const ClockRanks early = rank_clock_times(times, SharedRank::kEarliest);
  const ClockRanks late = rank_clock_times(times, SharedRank::kLatest);
  EXPECT_EQ(early.times.size(), 50000u);
  for (std::size_t k = 0; k < times.size(); ++k) {
    ASSERT_LT(early.ranks[k], kNeverLit);
    const std::int32_t even = static_cast<std::int32_t>(k - k % 2);
    ASSERT_EQ(early.times[early.ranks[k]], even);
    ASSERT_EQ(late.times[late.ranks[k]], even + 1);
  }
  times.resize(65535);
  EXPECT_EQ(rank_clock_times(times, SharedRank::kLatest).times.size(), 65535u);
}

}  // namespace
}  // namespace gnomon
