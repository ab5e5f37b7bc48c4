#include <Tpetra_Core.hpp>

#include "message.hpp"

namespace sprekk::base {
namespace {

TEST(Check, carries_values_in_its_message) {
  const int n = -3;
  EXPECT_EQ(message_of([&] { SPREKK_CHECK(n > 0, "cells must be positive, got {}", n); }),
            "cells must be positive, got -3");
  EXPECT_NO_THROW(SPREKK_CHECK(n < 0, "unused"));
}

TEST(Collectively, throws_on_every_rank_what_the_lowest_failing_rank_threw) {
  const auto comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank(), last = comm->getSize() - 1;
  EXPECT_EQ(message_of([&] { collectively(*comm, [&] { SPREKK_CHECK(rank != last, "rank {} failed", rank); }); }),
            "rank " + std::to_string(last) + " failed");
  EXPECT_EQ(message_of([&] { collectively(*comm, [&] { throw std::out_of_range("rank " + std::to_string(rank)); }); }),
            "rank 0");
  int ran = 0;
  EXPECT_NO_THROW(collectively(*comm, [&] { ++ran; }));
  EXPECT_EQ(ran, 1);
}

TEST(Collectively, lets_empty_messages_through) {
  const auto comm = Tpetra::getDefaultComm();
  EXPECT_EQ(message_of([&] { collectively(*comm, [] { throw Error(""); }); }), "");
}

}  // namespace
}  // namespace sprekk::base
