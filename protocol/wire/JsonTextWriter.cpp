#include "protocol/wire/JsonTextWriter.h"

#include <charconv>

namespace hermes {

void JsonTextWriter::separate() {
    if (out.isEmpty())
        return;
    const char last = out.back();
    if (last != '{' && last != '[' && last != ':')
        out.append(',');
}

void JsonTextWriter::separate(char next) {
    separate();
    out.append(next);
}

void JsonTextWriter::quote(const QString &text) {
    static const char digits[] = "0123456789abcdef";
    out.append('"');
    for (const char c : text.toUtf8()) {
        if (c == '"' || c == '\\')
            out.append('\\').append(c);
        else if (c == '\n')
            out.append("\\n");
        else if (uchar(c) < ' ')
            out.append("\\u00").append(digits[uchar(c) >> 4]).append(digits[c & 15]);
        else
            out.append(c);
    }
    out.append('"');
}

template <typename T>
void JsonTextWriter::digits(T value) {
    separate();
    char buffer[32];
    out.append(buffer, int(std::to_chars(buffer, buffer + sizeof buffer, value).ptr - buffer));
}

void JsonTextWriter::key(const QString &name) {
    separate();
    quote(name);
    out.append(':');
}

void JsonTextWriter::null() {
    separate();
    out.append("null");
}

void JsonTextWriter::boolean(bool value) {
    separate();
    out.append(value ? "true" : "false");
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
