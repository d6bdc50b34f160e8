// SPDX-License-Identifier: MIT
#include "renderer/import/models/statements.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace rtrays {

namespace {

bool is_blank(char letter) {
    return letter == ' ' || (letter >= '\t' && letter <= '\r');
}

}  // namespace

StatementReader::StatementReader(std::string_view text) : text_(text) {
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    if (text_.substr(0, byte_order_mark.size()) == byte_order_mark) {
        at_ = byte_order_mark.size();
    }
}

std::string_view StatementReader::take_line() {
    const size_t end = std::min(text_.find_first_of("\n\r", at_), text_.size());
    const std::string_view line = text_.substr(at_, end - at_);
    at_ = text_.substr(end, 2) == "\r\n" ? end + 2 : std::min(end + 1, text_.size());
    ++line_;
    return line;
}

bool StatementReader::next(Statement &statement) {
    while (at_ < text_.size()) {
        statement.line = line_ + 1;
        std::string_view line = take_line();
        if (!line.empty() && line.back() == '\\') {
            joined_.clear();
            while (!line.empty() && line.back() == '\\') {
                joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
                line = at_ < text_.size() ? take_line() : std::string_view();
            }
            joined_.append(line);
            line = joined_;
        }
        statement.rest = trimmed(line);
        if (!statement.rest.empty() && statement.rest.front() != '#') {
            statement.keyword = take_word(statement.rest);
            statement.rest = trimmed(statement.rest);
            return true;
        }
    }
    return false;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_blank(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

std::string_view take_word(std::string_view &text) {
    size_t begin = 0;
    while (begin < text.size() && is_blank(text[begin])) {
        ++begin;
    }
    size_t end = begin;
    while (end < text.size() && !is_blank(text[end])) {
        ++end;
    }
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

std::string_view without_comment(std::string_view rest) {
    return rest.substr(0, rest.find('#'));
}

std::string name_of(std::string_view rest) {
    for (size_t i = 0; i < rest.size(); ++i) {
        if (rest[i] == '#' && (i == 0 || is_blank(rest[i - 1]))) {
            rest = rest.substr(0, i);
        }
    }
    return std::string(trimmed(rest));
}

bool parse_number(std::string_view word, double &value) {
    if (!word.empty() && word.front() == '+') {
        word.remove_prefix(1);
    }
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    if (parsed.ec == std::errc::result_out_of_range) {
        const bool is_small =
            word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
        value = is_small ? 0 : HUGE_VAL;
    }
    return parsed.ec != std::errc::invalid_argument && parsed.ptr == word.data() + word.size();
}

std::string shown(std::string_view text) {
    constexpr size_t longest = 40;
    std::string printable(text.substr(0, longest));
    for (char &letter : printable) {
        letter = letter >= ' ' && letter <= '~' ? letter : '?';
    }
    return text.size() > longest ? printable + "..." : printable;
}

}  // namespace rtrays
