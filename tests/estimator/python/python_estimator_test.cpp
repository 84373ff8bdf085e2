// SPDX-License-Identifier: BSD-3-Clause
// Without an interpreter: tests/python/test_own_estimators.py has the rest.
#include "estimator/python/python_estimator.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "estimator/estimator_spec.hpp"
#include "estimator/python/python_process.hpp"

namespace aims {
namespace {

TEST(PythonEstimator, NamesAreModuleAndClass) {
  for (const char* name : {"python:module.Class", "python:a.b.c.Class_2"}) {
    EXPECT_TRUE(check_python_name(name)) << name;
  }
  for (const char* name : {"python:", "python:module", "python:module.", "python:.Class",
                           "python:mod ule.Class", "python:module.Cl-ass"}) {
    const auto checked = check_python_name(name);
    ASSERT_FALSE(checked) << name;
    EXPECT_NE(checked.error().message.find("expected python:module.Class"), std::string::npos);
  }
}

TEST(PythonEstimator, SpecsHaveLabelAndSettings) {
  const auto spec = parse_estimator_spec("mine=python:my.module.Mine+gain=1e+3+name=x");
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->label, "mine");
  EXPECT_EQ(spec->name, "python:my.module.Mine");
  ASSERT_EQ(spec->settings.size(), 2U);
  EXPECT_EQ(spec->settings[0].second, "1e+3");
  EXPECT_EQ(label_of("python:my.module.Mine"), "python_my_module_Mine");
  EXPECT_FALSE(parse_estimator_spec("aims=python:my.Mine"));
}

TEST(PythonEstimator, AMissingInterpreterIsNamed) {
  ASSERT_EQ(::setenv("AIMS_PYTHON", "/no/such/python", 1), 0);
  EstimatorConfigs configs;
  const auto added = configs.add_python("python:module.Class");
  ::unsetenv("AIMS_PYTHON");
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().message.find("no Python interpreter '/no/such/python'"),
            std::string::npos)
      << added.error().message;
}

TEST(PythonEstimator, AnInterpreterThatHangsIsEnded) {
  const std::string script = testing::TempDir() + "/hanging_python";
  std::ofstream(script) << "#!/bin/sh\nexec sleep 100\n";
  std::filesystem::permissions(script, std::filesystem::perms::owner_all);
  ASSERT_EQ(::setenv("AIMS_PYTHON", script.c_str(), 1), 0);
  const auto loaded = PythonConfig::load("python:module.Class", 0.05);
  ::unsetenv("AIMS_PYTHON");
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().message,
            "python:module.Class: start of Python: the call has not ended within 0.05 s "
            "(call_timeout)");
}

TEST(PythonMessage, ACursorEndsWhereTheMessageIsTooShort) {
  PipeMessage message;
  message.add_text("text");
  message.add(7.5);
  MessageCursor whole(message.bytes());
  EXPECT_EQ(whole.take_text(), "text");
  EXPECT_EQ(whole.take<double>(), 7.5);
  EXPECT_TRUE(whole.at_end());
  EXPECT_FALSE(whole.is_short());
  MessageCursor cut(message.bytes().first(message.bytes().size() - 1));
  EXPECT_EQ(cut.take_text(), "text");
  EXPECT_EQ(cut.take<double>(), 0.0);
  EXPECT_TRUE(cut.is_short());
  PipeMessage huge;
  huge.add(std::uint64_t{1} << 60);
  MessageCursor of_huge(huge.bytes());
  EXPECT_EQ(of_huge.take_text(), "");
  EXPECT_TRUE(of_huge.is_short());
}

TEST(PythonPoints, PartsInUseAreNotWrittenAgain) {
  SharedMemory points;
  ASSERT_TRUE(points.create());
  std::vector<LidarPoint> scan(100);
  scan[0].ring = 1;
  const auto first = points.put(scan);
  ASSERT_TRUE(first);
  scan[0].ring = 2;
  const auto second = points.put(scan);
  ASSERT_TRUE(second);
  EXPECT_NE(first->offset, second->offset) << "the first is in use until it is stated otherwise";
  points.keep(std::vector{second->offset});
  const auto third = points.put(scan);
  EXPECT_EQ(third->offset, first->offset);
  EXPECT_EQ(static_cast<const LidarPoint*>(second->memory)->ring, 2);
  scan.resize(100'000);
  const auto large = points.put(scan);
  EXPECT_GE(large->capacity, 100'000 * sizeof(LidarPoint));
  EXPECT_EQ(points.put({})->memory, nullptr);
}

}  // namespace
}  // namespace aims
