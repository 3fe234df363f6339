#include "protocol/wire/JsonWriters.h"

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

void JsonValueWriter::finite(float value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    double shortest = 0;
    std::from_chars(text, end, shortest);
    put(shortest);
}

void JsonValueWriter::put(const QJsonValue &value) {
    if (open_.empty())
        root_ = value;
    else if (open_.back().isObject)
        open_.back().object.insert(open_.back().key, value);
    else
        open_.back().array.append(value);
}

} // namespace hermes
