#include "protocol/wire/JsonValueWriter.h"

#include <charconv>

namespace hermes {

void JsonValueWriter::finite(float value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    double shortest = 0;
    std::from_chars(text, end, shortest);
    put(shortest);
}

void JsonValueWriter::put(const QJsonValue &value) {
    if (open.empty())
        root = value;
    else if (open.back().isObject)
        open.back().object.insert(open.back().key, value);
    else
        open.back().array.append(value);
}

void JsonValueWriter::close() {
    const Level level = std::move(open.back());
    open.pop_back();
    put(level.isObject ? QJsonValue(level.object) : QJsonValue(level.array));
}

} // namespace hermes
