#include "protocol/wire/JsonTextWriter.h"

#include <charconv>

namespace hermes {

void JsonTextWriter::separate() {
    if (out_.isEmpty())
        return;
    const char last = out_.back();
    if (last != '{' && last != '[' && last != ':')
        out_.append(',');
}

void JsonTextWriter::separate(char next) {
    separate();
    out_.append(next);
}

void JsonTextWriter::quote(const QString &text) {
    static const char digits[] = "0123456789abcdef";
    out_.append('"');
    for (const char c : text.toUtf8()) {
        if (c == '"' || c == '\\')
            out_.append('\\').append(c);
        else if (c == '\n')
            out_.append("\\n");
        else if (uchar(c) < ' ')
            out_.append("\\u00").append(digits[uchar(c) >> 4]).append(digits[c & 15]);
        else
            out_.append(c);
    }
    out_.append('"');
}

template <typename T>
void JsonTextWriter::digits(T value) {
    separate();
    char buffer[32];
    out_.append(buffer, int(std::to_chars(buffer, buffer + sizeof buffer, value).ptr - buffer));
}

void JsonTextWriter::key(const QString &name) {
    separate();
    quote(name);
    out_.append(':');
}

void JsonTextWriter::null() {
    separate();
    out_.append("null");
}

void JsonTextWriter::boolean(bool value) {
    separate();
    out_.append(value ? "true" : "false");
}

void JsonTextWriter::integer(qint64 value) {
    digits(value);
}

void JsonTextWriter::text(const QString &value) {
    separate();
    quote(value);
}

void JsonTextWriter::finite(double value) {
    digits(value);
}

void JsonTextWriter::finite(float value) {
    digits(value);
}

} // namespace hermes
