// SPDX-License-Identifier: BSD-3-Clause
#include "tests/recordings/stream/split_recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "recordings/source/conversion.hpp"

namespace aims::test {

void split_recording(const std::filesystem::path& whole, std::vector<SplitPart> parts) {
  std::vector<std::string> taken;
  for (const SplitPart& part : parts) {
    taken.insert(taken.end(), part.topics.begin(), part.topics.end());
  }
  for (SplitPart& part : parts) {
    auto source = open_recording(whole);
    ASSERT_TRUE(source) << source.error().message;
    const bool rest = part.topics.empty();
    for (const BagConnection& each : (*source)->connections()) {
      const bool other = std::ranges::find(taken, each.topic) != taken.end();
      if (rest && !other) part.topics.push_back(each.topic);
    }
    (*source)->select(part.topics);
    auto sink = create_recording(part.file, part.format);
    ASSERT_TRUE(sink) << sink.error().message;
    const auto done = convert_messages(**source, **sink, [](Time) { return true; });
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_GT(done->messages, 0U);
  }
}

}  // namespace aims::test
