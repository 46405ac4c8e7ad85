#!/usr/bin/env python3
"""test/sizes.py against a made-up tree: what it counts, what it leaves out, and what its exceptions may be."""
import os
import shutil
import tempfile
import textwrap
import unittest

import sizes

HEADER = '''\
#ifndef SAMPLE_H
#define SAMPLE_H
namespace inverter_bus
{
namespace bus
{
// class Commented { int no_; };
/* struct AlsoCommented { private: int no_; }; */
class Whole : public Base, private std::vector<int>
{
public:
  Whole() = default;
  explicit Whole(int first);
  ~Whole() override;
  Whole(const Whole&) = delete;
  Whole& operator=(const Whole&) = delete;
  bool operator==(const Whole& other) const;                        // method 1
  [[nodiscard]] int get() const noexcept { return first_; }         // 2
  static int make(                                                  // 3
      int first,
      std::function<void(int, int)> then = [](int, int) {});
  template <typename T>
  T convert(const T& value) const;                                  // 4
  void convert(int value,                                           // 5
               int again);
  virtual void pure() = 0;                                          // 6
  auto trailing() const -> std::vector<int>;                        // 7
  friend class Other;
  friend bool operator<(const Whole& a, const Whole& b);
  friend void swapBoth(Whole& a, Whole& b) { std::swap(a.first_, b.first_); }
  using Callback = std::function<void(int)>;
  typedef int Number;
  static constexpr int LIMIT = 3;
  static const std::map<std::string, int> TABLE;
  enum class Mode : std::uint8_t
  {
    One,
    Two
  };

  /// Nested, and data
  struct Nested
  {
    int a = 0, b = 1;
    std::array<int, 3> c{ { 1, 2, 3 } };
    bool empty() const { return a < b; }
  };

  class Inner
  {
    int hidden_;

  public:
    int shown() const;
  };

protected:
  void hook();                                                      // 8

private:
  struct Secret;
  void act(int a);                                                  // 9
  int first_ = 0;                                                   // member 1
  int second_{ 0 }, third_{ 1 };                                    // 2, 3
  std::function<void(const std::string& text, int n)> callback_;    // 4
  void (*pointer_)(int) = nullptr;                                  // 5
  std::map<std::string,                                             // 6
           std::vector<std::pair<int, int>>>
      table_;
  unsigned bits_ : 3;                                               // 7
  std::string text_ = "class Fake { private: int x_; };";           // 8
  std::string raw_ = R"(}; class Fake { private: int y_; )";        // 9
  std::function<int()> lambda_ = [this] { int local = 3; return local; };  // 10
  mutable std::mutex mutex_;                                        // 11
  std::atomic<bool> stop_{ false };                                 // 12
  char buffer_[16];                                                 // 13
  const Line& line_;                                                // 14
  std::unique_ptr<Secret> secret_;                                  // 15
  decltype(std::chrono::steady_clock::now()) since_;                // 16
};

template <typename T, std::size_t N = (1 > 0)>
class Templated final
{
public:
  explicit Templated(T value) : value_(value) {}
  T value() const
  {
    return value_;
  }

private:
  T value_;
  std::array<T, N> more_;
};

template <>
class Templated<int>
{
  int only_;
};

struct Data
{
  int a;
  int b;
  Data& operator+=(const Data& other);
  bool empty() const;
};

struct Sealed
{
  int open;

private:
  int shut_;
};

class Declared;
}  // namespace bus
}  // namespace inverter_bus
#endif
'''

SOURCE = '''\
namespace inverter_bus::bus
{
namespace
{
class Hidden
{
  int a_;
  void run() const {}
};

int choose(int a,
           int b)
{
  struct Local
  {
    int v;

  private:
    int w_;
  };
  auto lambda = [&](int c)
  {
    return c + a;
  };
  return lambda(b);
}
}  // namespace

int Whole::get()
try
{
  return 1;
}
catch (...)
{
  return 2;
}

Whole::Whole(int first)
  : first_(first)
  , second_{ 2 }
{
}

template <typename T>
T Whole::convert(const T& value) const
{
  return value;
}
}  // namespace inverter_bus::bus
'''


def long_function(name, lines):
    """A definition of so many lines."""
    return 'int %s()\n{\n%s  return 0;\n}\n' % (name, '  work();\n' * (lines - 4))


def a_class(name, methods, members):
    return 'class %s\n{\n%s%s};\n' % (name, ''.join('  void m%d();\n' % i for i in range(methods)),
                                      ''.join('  int v%d_;\n' % i for i in range(members)))


class Tree(unittest.TestCase):
    def setUp(self):
        if sizes.missing():
            self.skipTest(sizes.missing())
        self.root = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.root)
        self.write(sizes.EXCEPTIONS, '')

    def write(self, path, text):
        full = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, 'w') as stream:
            stream.write(text)

    def measured(self, kind):
        found = sizes.measure(self.root, sizes.sources(self.root))
        return {(size.name, size.line): size.number for size in found if size.kind == kind}

    def line(self, text, source):
        return source.split(text)[0].count('\n') + 1


class Counts(Tree):
    """What is in the samples, counted by hand."""

    def setUp(self):
        super().setUp()
        self.write('include/inverter_bus/bus/sample.h', HEADER)
        self.write('src/bus/deeper/sample.cpp', SOURCE)
        self.write('src/bus/private.h', a_class('Private', 2, 1))

    def expect(self, methods, members):
        lines = {'bus::Whole': self.line('class Whole', HEADER), 'bus::Whole::Inner': self.line('  class Inner', HEADER),
                 'bus::Templated': self.line('class Templated final', HEADER), 'bus::Sealed': self.line('struct Sealed', HEADER),
                 'bus::Templated<int>': self.line('class Templated<int>', HEADER),
                 'bus::Hidden': self.line('class Hidden', SOURCE), 'bus::choose::Local': self.line('  struct Local', SOURCE),
                 'Private': 1}
        for kind, numbers in (('methods', methods), ('members', members)):
            self.assertEqual({(name.replace('<int>', ''), lines[name]): number for name, number in numbers.items()},
                             self.measured(kind))

    def test_classes(self):
        # Not among them: Nested and Data, which are data.
        self.expect(methods={'bus::Whole': 9, 'bus::Whole::Inner': 1, 'bus::Templated': 1, 'bus::Templated<int>': 0,
                             'bus::Sealed': 0, 'bus::Hidden': 1, 'bus::choose::Local': 0, 'Private': 2},
                    members={'bus::Whole': 16, 'bus::Whole::Inner': 1, 'bus::Templated': 2, 'bus::Templated<int>': 1,
                             'bus::Sealed': 2, 'bus::Hidden': 1, 'bus::choose::Local': 2, 'Private': 1})

    def test_functions(self):
        # A lambda is part of its function. "int Whole::get()" has a try block for its body.
        lines = {name: (number, line) for (name, line), number in self.measured('function').items()}
        self.assertEqual((16, self.line('int choose', SOURCE)), lines['bus::choose'])
        self.assertEqual((5, self.line('Whole::Whole', SOURCE)), lines['bus::Whole::Whole'])
        self.assertEqual((4, self.line('T Whole::convert', SOURCE)), lines['bus::Whole::convert'])
        self.assertEqual((9, self.line('int Whole::get', SOURCE)), lines['bus::Whole::get'])
        self.assertEqual((1, self.line('  void run', SOURCE)), lines['bus::Hidden::run'])
        self.assertEqual((4, self.line('  T value() const', HEADER)), lines['bus::Templated::value'])

    def test_files(self):
        self.assertEqual({path: text.count('\n') for path, text in (
            ('include/inverter_bus/bus/sample.h', HEADER), ('src/bus/deeper/sample.cpp', SOURCE),
            ('src/bus/private.h', a_class('Private', 2, 1)))},
            {path: number for (path, line), number in self.measured('file').items()})


class Limits(Tree):
    def findings(self):
        return sizes.check(self.root)

    def test_what_is_at_its_limit_is_fine(self):
        self.write('src/bus/full.cpp', '\n' * 400)
        self.write('src/wire/full.cpp', '\n' * 500)
        self.write('src/wire/function.cpp', long_function('full', 60))
        self.write('src/wire/class.h', a_class('Full', 25, 12))
        self.assertEqual([], self.findings())

    def test_what_is_above_is_named_with_file_and_line(self):
        self.write('include/inverter_bus/bus/long.h', '\n' * 401)
        self.write('src/bus/rules/long.cpp', '\n' * 401)
        self.write('src/busy/long.cpp', '\n' * 501)
        self.write('fuzz/bus/checks/long.cpp', '\n' * 401)
        self.write('fuzz/bytes/long.cpp', '\n' * 600)  # has no limit
        self.write('src/wire/function.cpp', '\n\n' + long_function('tooLong', 61))
        self.write('src/wire/class.h', '\n' + a_class('TooMuch', 26, 13))
        self.assertEqual(['fuzz/bus/checks/long.cpp:401: the file has 401 lines, at most 400',
                          'include/inverter_bus/bus/long.h:401: the file has 401 lines, at most 400',
                          'src/bus/rules/long.cpp:401: the file has 401 lines, at most 400',
                          'src/busy/long.cpp:501: the file has 501 lines, at most 500',
                          'src/wire/class.h:2: class TooMuch has 26 methods, at most 25',
                          'src/wire/class.h:2: class TooMuch has 13 data members, at most 12',
                          'src/wire/function.cpp:3: function tooLong has 61 lines, at most 60'], self.findings())

    def test_a_struct_without_private_members_is_data(self):
        self.write('src/wire/data.h', a_class('Data', 30, 30).replace('class', 'struct'))
        self.assertEqual([], self.findings())

    def test_an_exception_holds_up_to_its_number(self):
        self.write('src/wire/long.cpp', '\n' * 600)
        self.write(sizes.EXCEPTIONS, '# comment\n\nfile 600 src/wire/long.cpp a table of a standard\n')
        self.assertEqual([], self.findings())
        self.write('src/wire/long.cpp', '\n' * 601)
        self.assertEqual(['src/wire/long.cpp:601: the file has 601 lines, at most 600 as an exception'], self.findings())

    def test_an_exception_must_follow_what_shrinks(self):
        self.write('src/wire/long.cpp', '\n' * 572)
        self.write(sizes.EXCEPTIONS, '\nfile 600 src/wire/long.cpp a table of a standard\n')
        self.assertEqual([], self.findings())
        self.write('src/wire/long.cpp', '\n' * 571)
        self.assertEqual([sizes.EXCEPTIONS + ':2: file src/wire/long.cpp: too high, it is down to 571'], self.findings())
        self.write('src/wire/long.cpp', '\n' * 500)
        self.assertEqual([sizes.EXCEPTIONS + ':2: file src/wire/long.cpp: no longer needed, it is down to 500'],
                         self.findings())
        os.remove(os.path.join(self.root, 'src/wire/long.cpp'))
        self.assertEqual([sizes.EXCEPTIONS + ':2: file src/wire/long.cpp: does not exist'], self.findings())

    def test_an_exception_is_for_one_kind_only(self):
        self.write('src/wire/class.h', 'namespace inverter_bus {\n%s}\n' % a_class('TooMuch', 26, 13))
        self.write(sizes.EXCEPTIONS, 'methods 26 TooMuch a reason\n')
        self.assertEqual(['src/wire/class.h:2: class TooMuch has 13 data members, at most 12'], self.findings())

    def test_the_largest_of_overloaded_functions_counts(self):
        self.write('src/wire/functions.cpp', long_function('overloaded', 61) + long_function('overloaded', 80))
        self.write(sizes.EXCEPTIONS, 'function 80 overloaded a reason\n')
        self.assertEqual([], self.findings())

    def test_a_list_of_exceptions_has_reasons_and_no_line_twice(self):
        self.write('src/wire/long.cpp', '\n' * 600)
        self.write(sizes.EXCEPTIONS, textwrap.dedent('''\
            file 600 src/wire/long.cpp a reason
            file 600 src/wire/long.cpp a reason
            file 600 src/wire/other.cpp
            lines 600 src/wire/other.cpp a reason
        '''))
        wrong = 'not KIND NUMBER NAME REASON, with function, methods, members or file as its kind'
        self.assertEqual([sizes.EXCEPTIONS + ':2: file src/wire/long.cpp is listed twice',
                          sizes.EXCEPTIONS + ':3: ' + wrong, sizes.EXCEPTIONS + ':4: ' + wrong], self.findings())


if __name__ == '__main__':
    unittest.main()
