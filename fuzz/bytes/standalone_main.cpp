// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 the inverter_bus authors
// Runs a fuzz target where there is no libFuzzer: the corpus, then random changes of it.
//
//   fuzz_<target> [-runs=N] [-seed=S] [-max_len=BYTES] [-max_total_time=SECONDS] [CORPUS...]
//
// CORPUS: files and directories. Other libFuzzer options are ignored. An input that crashes, or takes more than 10 s of
// computing, is written to crash-<program> in the working directory.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace
{
using Input = std::vector<std::uint8_t>;

/// Seconds of computing that one input may take; a busy machine does not count.
constexpr int LONGEST_INPUT = 10;

// What the signal handlers see.
const std::uint8_t* current_data = nullptr;
std::size_t current_size = 0;
volatile std::sig_atomic_t seconds_in_input = 0;
std::string crash_file;
char handler_stack[65536];

void writeCrash(const char* what)
{
  const int file = ::open(crash_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  bool written = file >= 0 && current_data != nullptr;
  written = written && ::write(file, current_data, current_size) == static_cast<ssize_t>(current_size);
  for (const char* text : { "\n", what, written ? "; input in " : "; input lost: ", crash_file.c_str(), "\n" })
  {
    written = ::write(STDERR_FILENO, text, std::strlen(text)) > 0;
  }
}

extern "C" void onCrash(int number)
{
  writeCrash("crashed");
  // SA_RESETHAND: as it would have ended without us.
  ::raise(number);
}

extern "C" void onSecond(int)
{
  seconds_in_input = seconds_in_input + 1;
  if (seconds_in_input > LONGEST_INPUT)
  {
    writeCrash("took more than 10 s");
    ::_exit(1);
  }
}

void installHandlers(const std::string& program)
{
  crash_file = "crash-" + std::filesystem::path(program).filename().string();
  stack_t stack{};
  stack.ss_sp = handler_stack;
  stack.ss_size = sizeof handler_stack;
  ::sigaltstack(&stack, nullptr);
  struct sigaction crash = {};
  crash.sa_handler = onCrash;
  crash.sa_flags = static_cast<int>(SA_ONSTACK | SA_RESETHAND | SA_NODEFER);
  for (const int number : { SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL })
  {
    ::sigaction(number, &crash, nullptr);
  }
  struct sigaction tick = {};
  tick.sa_handler = onSecond;
  tick.sa_flags = SA_RESTART;
  ::sigaction(SIGPROF, &tick, nullptr);
  const itimerval every_second{ { 1, 0 }, { 1, 0 } };
  ::setitimer(ITIMER_PROF, &every_second, nullptr);
}

void runOne(const Input& input)
{
  // A block of its own, so that a sanitizer sees every byte behind its end.
  const Input exact(input.begin(), input.end());
  current_data = exact.data();
  current_size = exact.size();
  seconds_in_input = 0;
  LLVMFuzzerTestOneInput(exact.data(), exact.size());
  current_data = nullptr;
  current_size = 0;
}

Input readInput(const std::filesystem::path& path)
{
  std::ifstream file(path, std::ios::binary);
  return Input(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

std::vector<Input> readCorpus(const std::vector<std::string>& places)
{
  std::vector<std::filesystem::path> paths;
  for (const std::string& place : places)
  {
    if (!std::filesystem::is_directory(place))
    {
      paths.emplace_back(place);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(place))
    {
      paths.push_back(entry.path());
    }
  }
  // The order of a directory is not the same everywhere; a seed is to mean the same run.
  std::sort(paths.begin(), paths.end());
  std::vector<Input> corpus;
  for (const std::filesystem::path& path : paths)
  {
    corpus.push_back(readInput(path));
  }
  return corpus;
}

/// Changes of the kinds that libFuzzer makes, without its knowledge of what they reach.
class Mutator
{
public:
  Mutator(std::vector<Input> corpus, std::uint64_t seed, std::size_t longest)
    : corpus_(std::move(corpus)), random_(seed), longest_(longest)
  {
    if (corpus_.empty())
    {
      corpus_.emplace_back();
    }
  }

  const std::vector<Input>& corpus() const
  {
    return corpus_;
  }

  Input next()
  {
    Input input = corpus_[below(corpus_.size())];
    for (std::size_t changes = 1 + below(5); changes > 0; --changes)
    {
      change(input);
    }
    input.resize(std::min(input.size(), longest_));
    return input;
  }

private:
  std::size_t below(std::size_t limit)
  {
    return limit == 0 ? 0 : static_cast<std::size_t>(random_() % limit);
  }

  std::uint8_t byte()
  {
    static const std::uint8_t SPECIAL[] = {
      0x00, 0x01, 0x02, 0x03, 0x7F, 0x80, 0xFF, '\n', ' ', ':', '-', '"', '0', '9'
    };
    return below(3) == 0 ? SPECIAL[below(sizeof SPECIAL)] : static_cast<std::uint8_t>(random_());
  }

  void change(Input& input)
  {
    const std::size_t place = below(input.size() + 1);
    const auto at = input.begin() + static_cast<std::ptrdiff_t>(place);
    const std::size_t count = std::min(1 + below(1 + below(16)), input.size() - place);
    switch (below(6))
    {
      case 0:
        flip(input, place);
        break;
      case 1:
        std::generate(at, at + static_cast<std::ptrdiff_t>(count), [this] { return byte(); });
        break;
      case 2:
        input.insert(at, 1 + below(4), byte());
        break;
      case 3:
        input.erase(at, at + static_cast<std::ptrdiff_t>(count));
        break;
      case 4:
        splice(input, place, input);
        break;
      default:
        splice(input, place, corpus_[below(corpus_.size())]);
    }
  }

  void flip(Input& input, std::size_t place)
  {
    if (place < input.size())
    {
      input[place] = static_cast<std::uint8_t>(input[place] ^ 1U << below(8));
    }
  }

  /// Puts a part of \p other there, in place of what was there or in front of it.
  void splice(Input& input, std::size_t place, const Input& other)
  {
    const std::size_t from = below(other.size());
    const std::size_t count = below(other.size() - from + 1);
    const Input part(other.begin() + static_cast<std::ptrdiff_t>(from),
                     other.begin() + static_cast<std::ptrdiff_t>(from + count));
    const auto at = input.begin() + static_cast<std::ptrdiff_t>(place);
    const std::size_t replaced = below(2) == 0 ? 0 : std::min(count, input.size() - place);
    input.insert(input.erase(at, at + static_cast<std::ptrdiff_t>(replaced)), part.begin(), part.end());
  }

  std::vector<Input> corpus_;
  std::mt19937_64 random_;
  std::size_t longest_;
};

struct Options
{
  std::uint64_t runs = 0;
  std::uint64_t seed = 1;
  std::size_t longest = 4096;
  double seconds = 0.0;
  std::vector<std::string> places;
};

Options readOptions(int argc, char** argv)
{
  Options options;
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    const std::string name = argument.substr(0, equals);
    const char* const value = equals == std::string::npos ? "" : argv[i] + equals + 1;
    if (name == "-runs")
    {
      options.runs = std::strtoull(value, nullptr, 10);
    }
    else if (name == "-seed")
    {
      options.seed = std::strtoull(value, nullptr, 10);
    }
    else if (name == "-max_len")
    {
      options.longest = static_cast<std::size_t>(std::strtoull(value, nullptr, 10));
    }
    else if (name == "-max_total_time")
    {
      options.seconds = std::strtod(value, nullptr);
    }
    else if (argument[0] != '-')
    {
      options.places.push_back(argument);
    }
  }
  return options;
}
}  // namespace

int main(int argc, char** argv)
{
  const Options options = readOptions(argc, argv);
  Mutator mutator(readCorpus(options.places), options.seed, options.longest);
  installHandlers(argv[0]);
  for (const Input& input : mutator.corpus())
  {
    runOne(input);
  }
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [start] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  // Without -runs: until the time is over, as libFuzzer has it.
  const std::uint64_t most = options.runs == 0 && options.seconds > 0.0 ? UINT64_MAX : options.runs;
  std::uint64_t runs = 0;
  while (runs < most && (options.seconds <= 0.0 || elapsed() < options.seconds))
  {
    runOne(mutator.next());
    ++runs;
  }
  std::printf("%zu inputs of the corpus and %llu changes of them in %.1f s: no finding\n", mutator.corpus().size(),
              static_cast<unsigned long long>(runs), elapsed());
  return 0;
}
