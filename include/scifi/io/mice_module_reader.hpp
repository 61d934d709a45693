// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <scifi/io/mice_line_reader.hpp>
#include <scifi/io/mice_module.hpp>

namespace scifi {

namespace detail {

/// Rotation of the axes by angles (rad) about x, then y, then z, as the format has it: the matrix of parent_to_child.
[[nodiscard]] inline matrix<double, 3, 3> mice_rotation(const std::vector<double>& angles) {
  // sin(pi) is not zero to the last bit, and a flipped tracker shall not be tilted by that.
  const auto turn = [](double angle, int a, int b) {
    constexpr double rounding = 1.0e-15;
    const auto clean = [](double x) { return std::abs(x) < rounding ? 0.0 : x; };
    matrix<double, 3, 3> m = matrix<double, 3, 3>::Identity();
    m(a, a) = m(b, b) = clean(std::cos(angle));
    m(b, a) = clean(std::sin(angle));
    m(a, b) = -m(b, a);
    return m;
  };
  return turn(angles[2], 0, 1) * turn(angles[1], 2, 0) * turn(angles[0], 1, 2);
}

/// Reads a MiceModules file and those it refers to.
class mice_module_parser {
 public:
  [[nodiscard]] mice_module read(const std::filesystem::path& top) {
    top_ = top;
    return read_file(top, nullptr);
  }

 private:
  using statement = mice_line_reader::statement;

  /// $NAME is replaced by its text in the block where it is defined and in all inside.
  struct scope {
    const scope* outer = nullptr;
    std::map<std::string, std::string, std::less<>> substitutions;

    [[nodiscard]] const std::string* find(std::string_view name) const {
      for (const scope* s = this; s != nullptr; s = s->outer)
        if (const auto found = s->substitutions.find(name); found != s->substitutions.end()) return &found->second;
      return nullptr;
    }
  };

  [[nodiscard]] mice_module read_file(const std::filesystem::path& path, const scope* outer) {
    mice_line_reader lines(path);
    statement s;
    if (!lines.next(s)) throw input_error(lines.name(), 0, "", "describes no module");
    if (s[0] != "Module" && s[0] != "Configuration") lines.fail("", in_quotes(s[0]) + ": a geometry begins with Configuration or Module");
    check_length(lines, s, 2, 2, "a name");
    mice_module m;
    m.name = s[1];
    m.file = lines.name();
    m.line = lines.line();
    files_.push_back(std::filesystem::weakly_canonical(path));
    read_block(lines, m, outer);
    files_.pop_back();
    if (lines.next(s)) lines.fail("", in_quotes(s[0]) + " after the end of the module");
    return m;
  }

  void read_block(mice_line_reader& lines, mice_module& m, const scope* outer) {
    constexpr int deepest = 64;
    constexpr long most_modules = 100'000;
    const long opened = lines.line();
    if (++depth_ > deepest) lines.fail("", "modules are nested more than " + std::to_string(deepest) + " deep");
    if (++modules_ > most_modules) lines.fail("", "more than " + std::to_string(most_modules) + " modules");
    statement s;
    if (!lines.next(s) || s[0] != "{") lines.fail("Module " + m.name, "is not followed by {");
    scope here{outer, {}};
    while (lines.next(s)) {
      if (s[0] == "}") {
        --depth_;
        return;
      }
      if (s[0] == "Module") m.children.push_back(read_child(lines, s, here));
      else read_line(lines, s, m, here);
    }
    throw input_error(lines.name(), opened, "Module " + m.name, "is not closed by }");
  }

  [[nodiscard]] mice_module read_child(mice_line_reader& lines, const statement& s, const scope& here) {
    check_length(lines, s, 2, 2, "a name");
    mice_module m;
    const long line = lines.line();
    if (s[1].ends_with(".dat")) {
      m.missing = true;
      if (const auto file = find_file(s[1], lines.name())) {
        const auto canonical = std::filesystem::weakly_canonical(*file);
        if (std::find(files_.begin(), files_.end(), canonical) != files_.end()) lines.fail("Module " + s[1], cycle(canonical));
        m = read_file(*file, &here);
      }
    }
    if (m.name.empty()) m.name = s[1];
    m.file = lines.name();
    m.line = line;
    read_block(lines, m, &here);
    if (!m.volume.empty()) m.missing = false;  // named like a file and described in place
    return m;
  }

  static void read_line(const mice_line_reader& lines, const statement& s, mice_module& m, scope& here) {
    const std::string& keyword = s[0];
    if (keyword == "Substitution") {
      check_length(lines, s, 3, 3, "a name with $ and its text");
      if (s[1].size() < 2 || s[1][0] != '$') lines.fail(keyword, in_quotes(s[1]) + " does not begin with $");
      here.substitutions.insert_or_assign(s[1].substr(1), s[2]);
      return;
    }
    const bool text = keyword == "PropertyString";
    mice_property p{keyword, "", lines.name(), lines.line(), {}};
    if (keyword.starts_with("Property")) {
      const bool numbers = keyword == "PropertyDouble" || keyword == "PropertyInt" || keyword == "PropertyHep3Vector";
      if (!text && !numbers && keyword != "PropertyBool") lines.fail("", in_quotes(keyword) + " is not known");
      const std::size_t values = keyword == "PropertyHep3Vector" ? 3 : 1;
      check_length(lines, s, 2 + values, text ? s.size() : 3 + values, values == 3 ? "a name and three numbers" : "a name and a value");
      p.name = s[1];
      for (std::size_t i = 2; i < s.size(); ++i) p.words.push_back(substituted(lines, s[i], here, text));
      for (std::size_t i = 0; numbers && i < values; ++i)
        if (!mice_expression(p.words[i])) p.fail(in_quotes(p.words[i]) + " is not a number");
      m.properties.insert_or_assign(p.name, std::move(p));
      return;
    }
    for (std::size_t i = 1; i < s.size(); ++i) p.words.push_back(substituted(lines, s[i], here, false));
    if (keyword == "Volume") {
      m.volume = p.text();
    } else if (keyword == "Dimensions") {
      constexpr std::size_t most_dimensions = 9;
      if (p.words.size() > most_dimensions + 1) p.fail("the line is too long");
      // One number at least, so that a line without a unit says so.
      const bool has_unit = !p.words.empty() && !mice_expression(p.words.back());
      m.dimensions = p.quantities(mice_quantity::length, std::max<std::size_t>(1, p.words.size() - (has_unit ? 1 : 0)));
    } else if (keyword == "Position") {
      const std::vector<double> x = p.quantities(mice_quantity::length, 3);
      m.position = {x[0], x[1], x[2]};
    } else if (keyword == "Rotation") {
      m.parent_to_child = mice_rotation(p.quantities(mice_quantity::angle, 3));
    } else if (keyword == "ScaleFactor") {
      m.scale_factor = p.number();
    } else {
      lines.fail("", in_quotes(keyword) + " is not known");
    }
  }

  /// `word` with its $NAMEs replaced, the longest name that fits: text is replaced by text, and the experiment's files rely on $Coil in $Coil2.
  /// An unknown one stays as it is in text (a variable of the environment) and is a mistake elsewhere.
  [[nodiscard]] static std::string substituted(const mice_line_reader& lines, std::string_view word, const scope& here, bool text) {
    constexpr std::size_t longest = 4096;
    std::string out;
    while (!word.empty()) {
      const std::string* value = nullptr;
      std::size_t taken = 1;
      for (std::size_t n = word.size(); word[0] == '$' && value == nullptr && n > 1; --n) {
        value = here.find(word.substr(1, n - 1));
        taken = value != nullptr ? n : 1;
      }
      if (value == nullptr && word[0] == '$' && !text) lines.fail("", in_quotes(word) + " has no Substitution");
      out += value != nullptr ? std::string_view(*value) : word.substr(0, 1);
      if (out.size() > longest) lines.fail("", "its Substitutions make a word of more than " + std::to_string(longest) + " bytes");
      word.remove_prefix(taken);
    }
    return out;
  }

  static void check_length(const mice_line_reader& lines, const statement& s, std::size_t least, std::size_t most, const char* needs) {
    if (s.size() < least) lines.fail(s[0], std::string("the line is too short: it needs ") + needs);
    if (s.size() > most) lines.fail(s[0], "the line is too long: " + in_quotes(s[most]) + " is not expected");
  }

  /// Looks in the folder of the first file and in that of the referring file and those above it; and in Modules beside the folder of the first.
  [[nodiscard]] std::optional<std::filesystem::path> find_file(const std::string& name, const std::filesystem::path& referring) const {
    namespace fs = std::filesystem;
    std::error_code none;
    const fs::path top = fs::absolute(top_).parent_path();
    std::vector<fs::path> folders{top, top.parent_path() / "Modules"};
    constexpr int levels = 4;
    fs::path folder = fs::absolute(referring).parent_path();
    for (int i = 0; i < levels; ++i, folder = folder.parent_path()) folders.push_back(folder);
    for (const fs::path& f : folders)
      if (fs::is_regular_file(f / name, none)) return (f / name).lexically_normal();
    return std::nullopt;
  }

  [[nodiscard]] std::string cycle(const std::filesystem::path& again) const {
    std::string out = "the file refers to itself: ";
    for (auto f = std::find(files_.begin(), files_.end(), again); f != files_.end(); ++f) out += f->filename().string() + " -> ";
    return out + again.filename().string();
  }

  std::filesystem::path top_;
  std::vector<std::filesystem::path> files_;
  int depth_ = 0;
  long modules_ = 0;
};

}  // namespace detail

/// The tree of modules that a MiceModules file (plain or gzip) describes, with the files it refers to put in their places. A module of which the
/// file is not there is `missing`. A repeated module appears once, as its first copy. Throws input_error with file, line and reason.
[[nodiscard]] inline mice_module read_mice_modules(const std::filesystem::path& path) { return detail::mice_module_parser().read(path); }

}  // namespace scifi
