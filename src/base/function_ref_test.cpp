// FunctionRef calls lambdas, functions and constant callables in place, without a copy.
#include "base/function_ref.h"

#include <gtest/gtest.h>

#include <memory>

namespace gyre::function_ref_test {
namespace {

int twice(int x) { return 2 * x; }

int call(FunctionRef<int(int)> fn, int x) { return fn(x); }

TEST(FunctionRef, CallsTheOriginal) {
  int sum = 0;
  const auto constant = [](int x) { return x + 1; };
  auto counting = [&sum](int x) mutable { return sum += x; };
  EXPECT_EQ(call(twice, 4), 8);
  EXPECT_EQ(call(&twice, 5), 10);
  EXPECT_EQ(call(constant, 4), 5);
  EXPECT_EQ(call(counting, 4), 4);
  EXPECT_EQ(call(counting, 3), 7);
  EXPECT_EQ(call([](int x) { return -x; }, 3), -3);
}

TEST(FunctionRef, CopiesReferToTheSame) {
  int calls = 0;
  auto counting = [&calls] { ++calls; };
  const FunctionRef<void()> first = counting;
  FunctionRef<void()> second = first;
  second();
  first();
  EXPECT_EQ(calls, 2);
}

TEST(FunctionRef, PassesArgumentsThrough) {
  auto take = [](std::unique_ptr<int> owned, int& out) { out = *owned; };
  const FunctionRef<void(std::unique_ptr<int>, int&)> fn = take;
  int out = 0;
  fn(std::make_unique<int>(6), out);
  EXPECT_EQ(out, 6);
}

TEST(FunctionRef, DropsResultsNobodyWants) {
  int calls = 0;
  auto answering = [&calls] { return ++calls; };
  const FunctionRef<void()> fn = answering;
  fn();
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace gyre::function_ref_test
