// SPDX-License-Identifier: BSD-3-Clause
// What one core of this machine can do at best: instructions and floating-point operations a
// second, and memory read in order and at random, by size of the working set.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "estimator/lidar/float4.hpp"

namespace aims {
namespace {

constexpr int kRepeats = 64;

/// Eight chains of `step`, independent of each other, in registers that the compiler does not know.
template <class Value, class Step>
void run_chains(benchmark::State& state, const Step& step) {
  Value a{}, b{}, c{}, d{}, e{}, f{}, g{}, h{};
  for (auto _ : state) {
    for (int i = 0; i < kRepeats; ++i) {
      step(a), step(b), step(c), step(d), step(e), step(f), step(g), step(h);
    }
  }
  for (Value value : {a, b, c, d, e, f, g, h}) benchmark::DoNotOptimize(value);
}

/// Additions.
void instructions(benchmark::State& state) {
  run_chains<std::uint64_t>(state, [](std::uint64_t& sum) {
    ++sum;
    asm volatile("" : "+r"(sum));
  });
  state.SetItemsProcessed(state.iterations() * kRepeats * 8);
}
BENCHMARK(instructions);

/// Products and sums of four numbers each.
void float_operations(benchmark::State& state) {
  run_chains<Float4>(state, [factor = Float4{} + 0.5F](Float4& value) {
    value = value * factor + factor;
    asm volatile("" : "+x"(value));
  });
  state.SetItemsProcessed(state.iterations() * kRepeats * 8 * 8);
}
BENCHMARK(float_operations);

/// Sum over `state.range(0)` kilobytes, in order.
void read_in_order(benchmark::State& state) {
  const std::vector<std::uint64_t> words(static_cast<std::size_t>(state.range(0)) * 1024 / 8, 1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(std::accumulate(words.begin(), words.end(), std::uint64_t{0}));
  }
  state.SetBytesProcessed(state.iterations() * state.range(0) * 1024);
}
BENCHMARK(read_in_order)->Arg(16)->Arg(512)->Arg(8192)->Arg(262144);

/// Cache lines of `state.range(0)` kilobytes, each found in the one before: its time is that until
/// a line arrives.
void read_at_random(benchmark::State& state) {
  struct alignas(64) Line {
    std::size_t next = 0;
  };
  std::vector<Line> lines(static_cast<std::size_t>(state.range(0)) * 1024 / sizeof(Line));
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  RandomStream random(1, "read_at_random");
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    const auto other = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i + 1)));
    std::swap(order[i], order[other]);
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    lines[order[i]].next = order[(i + 1) % order.size()];
  }
  std::size_t at = 0;
  for (auto _ : state) {
    for (int i = 0; i < kRepeats; ++i) at = lines[at].next;
    benchmark::DoNotOptimize(at);
  }
  state.SetItemsProcessed(state.iterations() * kRepeats);
}
BENCHMARK(read_at_random)->Arg(16)->Arg(512)->Arg(8192)->Arg(262144);

}  // namespace
}  // namespace aims
