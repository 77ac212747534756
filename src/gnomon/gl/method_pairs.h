// The combinations of choices that are tried when all are too many: so many that every two choices
// of different kinds that can come together do so in one of them (pairwise testing; Cohen, Dalal,
// Fredman, Patton: The AETG system, 1997).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <gnomon/gl/method.h>

namespace gnomon::gl {

// Asked again and again for the next method, and told what became of it:
//   while (auto m = pairs.next()) { draw *m; pairs.drawn(), pairs.refused(why) or pairs.skipped() }
class MethodPairs {
 public:
  // `known`: what is known of the situation beforehand: view, light, far plane. What is not (shapes
  // of casters, the near clip volume) is learned from what is refused. `all`: every supported
  // combination instead.
  MethodPairs(const Situation& known, const Capabilities& capabilities, bool all);

  std::optional<Method> next();
  void drawn();
  // True if decide() would have refused it for this reason; otherwise it was refused while drawing.
  bool refused(const std::string& why);
  void skipped();

 private:
  static constexpr std::size_t kKinds = 9;
  using Levels = std::array<std::uint8_t, kKinds>;
  struct Candidate {
    Levels levels;
    Method method;
  };
  bool supported(const Method& method) const;
  void keep_supported();
  int new_pairs(const Levels& levels) const;
  void cover(const Levels& levels);

  std::vector<Situation> situations_;  // that fit what is known
  Capabilities capabilities_;
  bool all_;
  std::vector<Candidate> left_;
  std::size_t last_ = 0;
  // Pairs that have been tried, by kind and level of both.
  static constexpr std::size_t kLevels = 8;
  std::vector<std::uint8_t> covered_ =
      std::vector<std::uint8_t>(kKinds * kLevels * kKinds * kLevels);
};

}  // namespace gnomon::gl
