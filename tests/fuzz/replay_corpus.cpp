// SPDX-License-Identifier: MPL-2.0
// Runs every target over its files in the corpus and over seeded mutations of them, without libFuzzer.
// Usage: replay_corpus CORPUS MUTATIONS [TARGET [FILE]]
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/target.hpp"

namespace {

/// A few changes of the kinds that break readers: bytes replaced, removed, doubled; numbers made absurd; parts of another file.
class mutator {
 public:
  explicit mutator(const std::vector<std::string>& files) : files_(files) {}

  std::string operator()() {
    std::string text = files_[below(files_.size())];
    for (std::size_t changes = 1 + below(4); changes > 0; --changes) change(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

  void change(std::string& text) {
    static const std::vector<std::string> absurd{"-1", "0", "1e400", "1e300", "-1e-320", "nan", "inf", "9223372036854775807", "2147483648", "-2147483648", "", "\"", ",", "{", "[[", "\n", "\r", std::string(1, '\0'), "\xff"};
    const std::size_t at = below(text.size() + 1);
    const std::size_t length = std::min(1 + below(16), text.size() - at);
    switch (below(6)) {
      case 0: if (at < text.size()) text[at] = static_cast<char>(below(256)); break;
      case 1: text.erase(at, length); break;
      case 2: text.insert(at, text.substr(at, length)); break;
      case 3: text.insert(at, absurd[below(absurd.size())]); break;
      case 4: {
        std::size_t first = text.find_first_of("0123456789", at);
        if (first == std::string::npos) break;
        const std::size_t end = std::min(text.find_first_not_of("0123456789.eE-+", first), text.size());
        text.replace(first, end - first, absurd[below(absurd.size())]);
        break;
      }
      default: {
        const std::string& other = files_[below(files_.size())];
        const std::size_t from = below(other.size() + 1);
        text.insert(at, other.substr(from, below(200)));
      }
    }
  }

  const std::vector<std::string>& files_;
  std::mt19937 random_{20261123};  // NOLINT: the same mutations every time
};

/// The files of a folder by name, so that mutations do not depend on the file system.
std::vector<std::string> contents(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> out;
  for (const auto& f : files) out.push_back(scifi::test::content_of(f));
  return out;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "Usage: replay_corpus CORPUS MUTATIONS [TARGET [FILE]]\n");
    return 2;
  }
  const std::filesystem::path corpus = arguments[1];
  const long mutations = std::strtol(arguments[2], nullptr, 10);
  const std::string_view wanted = count > 3 ? arguments[3] : "";
  std::size_t run = 0;
  for (const scifi::fuzz::target& t : scifi::fuzz::targets()) {
    if (!wanted.empty() && t.name != wanted) continue;
    ++run;
    if (count > 4) {
      t.run(scifi::test::content_of(arguments[4]));
      continue;
    }
    const std::vector<std::string> files = contents(corpus / t.name);
    if (files.empty()) {
      std::fprintf(stderr, "%s has no corpus\n", t.name.data());
      return 1;
    }
    // What is run is said before, for a crash to be traced to it.
    std::printf("%s: %zu files, %ld mutations\n", t.name.data(), files.size(), mutations);
    std::fflush(stdout);
    t.run("");
    for (const std::string& text : files) t.run(text);
    mutator mutated(files);
    for (long i = 0; i < mutations; ++i) t.run(mutated());
  }
  return run > 0 ? 0 : 2;
}
