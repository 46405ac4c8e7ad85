// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors

// One error of each kind that the sanitizer of this build is there for. test/run_all.py runs them and expects a report of
// each; without an argument the program names them. It ends as well as the sanitizer lets it.

#include <cstdlib>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace
{
#ifdef __SANITIZE_THREAD__
void race()
{
  int shared = 0;
  std::thread other([&shared] { ++shared; });
  ++shared;
  other.join();
  std::cout << shared << std::endl;
}

const std::map<std::string, std::function<void()>> ERRORS{ { "race", race } };
#else
void overflow(std::size_t size)
{
  const std::vector<char> bytes(size);
  std::cout << bytes.data()[size] << std::endl;
}

void leak()
{
  // Two, and the first forgotten: what is still in a register at the end does not count as lost.
  for (int count = 0; count < 2; ++count)
  {
    char* volatile forgotten = new char[100];
    forgotten[0] = 'x';
  }
}

void undefined(int most)
{
  std::cout << most + 1 << std::endl;
}

const std::map<std::string, std::function<void()>> ERRORS{
  { "overflow", [] { overflow(100); } },
  { "leak", leak },
  { "undefined", [] { undefined(std::numeric_limits<int>::max()); } },
};
#endif
}  // namespace

int main(int argc, char** argv)
{
  if (argc < 2)
  {
    for (const auto& error : ERRORS)
    {
      std::cout << error.first << std::endl;
    }
    return EXIT_SUCCESS;
  }
  ERRORS.at(argv[1])();
  return EXIT_SUCCESS;
}
