// SPDX-License-Identifier: MIT
// Lines, words and numbers of the text formats OBJ and MTL.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rtrays {

/// One statement of an OBJ or MTL file, without blanks at either end.
struct Statement {
    std::string_view keyword;
    std::string_view rest;  ///< what follows the keyword, with comments
    size_t line = 0;        ///< number of its first line, from 1
};

/// Splits a text into statements. Lines end with LF, CR LF or CR. A backslash before the end of a
/// line continues the statement on the next line. Empty lines, lines of comment and a byte order
/// mark are skipped.
class StatementReader {
  public:
    explicit StatementReader(std::string_view text);

    /// Moves to the next statement. Returns false at the end. The views of a statement are valid
    /// until the next call.
    bool next(Statement &statement);

    /// Number of bytes read so far.
    size_t position() const { return at_; }

  private:
    std::string_view take_line();

    std::string_view text_;
    size_t at_ = 0;
    size_t line_ = 0;
    std::string joined_;
};

/// Returns text without blanks at either end.
std::string_view trimmed(std::string_view text);

/// Removes the first word from `text` and returns it. Returns an empty word at the end.
std::string_view take_word(std::string_view &text);

/// Returns the numeric arguments of a statement. A '#' begins a comment.
std::string_view without_comment(std::string_view rest);

/// Returns a name that may contain blanks. A '#' after a blank begins a comment.
std::string name_of(std::string_view rest);

/// Reads a word as a number. Returns false unless the full word is a number. A number beyond the
/// range of double becomes infinite, or zero if it is too small.
bool parse_number(std::string_view word, double &value);

/// Returns text of a possibly damaged file in printable and short form, for messages.
std::string shown(std::string_view text);

}  // namespace rtrays
