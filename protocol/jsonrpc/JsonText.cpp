#include "protocol/jsonrpc/JsonText.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

namespace hermes {
namespace {

// Looks once over the text for what Qt's parser lets pass: keys that occur twice, deep nesting, control
// characters and unknown escapes in strings, numbers like .5 and 1. without a digit on both sides of the
// point. Takes no offence at anything else; Qt's parser does that afterwards.
class Scanner {
public:
    Scanner(const QByteArray &jsonText, int depthLimit)
        : text(jsonText)
        , maximumDepth(depthLimit) {}

    bool run(JsonTextError *error) {
        for (int i = 0; i < text.size(); ++i) {
            const char c = text[i];
            if (c == '"') {
                const int end = stringEnd(i);
                if (const int bad = badCharacter(i, end); bad < end)
                    return fail(error, bad,
                                QStringLiteral("a control character or an unknown escape in a string"));
                if (!open.empty() && isKey(end))
                    open.back().push_back(text.mid(i, end - i + 1));
                i = end;
            } else if (c == '{' || c == '[') {
                open.emplace_back();
                if (int(open.size()) > maximumDepth)
                    return fail(error, i, QStringLiteral("nested deeper than %1 levels").arg(maximumDepth));
            } else if ((c == '}' || c == ']') && !open.empty()) {
                if (const auto twice = repeatedKey(open.back()))
                    return fail(error, i,
                                QStringLiteral("the key %1 occurs twice in one object").arg(*twice));
                open.pop_back();
            } else if (c == '.' && !(isDigit(i - 1) && isDigit(i + 1))) {
                return fail(error, i, QStringLiteral("illegal number"));
            }
        }
        return true;
    }

private:
    int stringEnd(int start) const {
        for (int i = start + 1; i < text.size(); ++i) {
            if (text[i] == '\\')
                ++i;
            else if (text[i] == '"')
                return i;
        }
        return text.size() - 1;
    }

    int badCharacter(int start, int end) const {
        for (int i = start + 1; i < end; ++i) {
            if (uchar(text[i]) < ' ')
                return i;
            if (text[i] == '\\' && !std::strchr("\"\\/bfnrtu", text[++i]))
                return i;
        }
        return end;
    }

    bool isDigit(int i) const { return i >= 0 && i < text.size() && text[i] >= '0' && text[i] <= '9'; }

    bool isKey(int stringEnd) const {
        int i = stringEnd + 1;
        while (i < text.size() && std::string_view(" \t\r\n").find(text[i]) != std::string_view::npos)
            ++i;
        return i < text.size() && text[i] == ':';
    }

    static std::optional<QString> repeatedKey(std::vector<QByteArray> &keys) {
        for (QByteArray &key : keys) {
            if (key.contains('\\'))
                key = '"' + QJsonDocument::fromJson('[' + key + ']').array().at(0).toString().toUtf8() + '"';
        }
        std::sort(keys.begin(), keys.end());
        const auto found = std::adjacent_find(keys.begin(), keys.end());
        return found == keys.end() ? std::nullopt : std::optional<QString>(QString::fromUtf8(*found));
    }

    static bool fail(JsonTextError *error, int offset, const QString &message) {
        error->offset = offset;
        error->message = message;
        return false;
    }

    const QByteArray &text;
    const int maximumDepth;
    std::vector<std::vector<QByteArray>> open; // the keys seen in each object (or array: none) still open
};

void setLine(const QByteArray &text, JsonTextError *error) {
    const auto end = text.begin() + std::min(error->offset, text.size());
    error->line = 1 + int(std::count(text.begin(), end, '\n'));
}

bool startsContainer(const QByteArray &text) {
    for (const char c : text) {
        if (c != ' ' && c != '\t' && c != '\r' && c != '\n')
            return c == '{' || c == '[';
    }
    return false;
}

} // namespace

std::optional<QJsonValue> parseJson(const QByteArray &text, JsonTextError *error, int maximumDepth) {
    JsonTextError ignored;
    error = error ? error : &ignored;
    *error = JsonTextError();
    if (!Scanner(text, maximumDepth).run(error)) {
        setLine(text, error);
        return std::nullopt;
    }
    // Qt 5 parses only arrays and objects: a bare value is parsed as the single element of an array.
    const bool wrap = !startsContainer(text);
    QJsonParseError parseError;
    const QJsonDocument document = QJsonDocument::fromJson(wrap ? '[' + text + ']' : text, &parseError);
    const bool oneValue = !wrap || document.array().size() == 1;
    if (parseError.error != QJsonParseError::NoError || !oneValue) {
        error->message = oneValue ? parseError.errorString() : QStringLiteral("one JSON value expected");
        error->offset = std::clamp(parseError.offset - int(wrap), 0, text.size());
        setLine(text, error);
        return std::nullopt;
    }
    if (wrap)
        return document.array().at(0);
    return document.isArray() ? QJsonValue(document.array()) : QJsonValue(document.object());
}

QByteArray compactJson(const QJsonValue &value) {
    if (value.isObject())
        return QJsonDocument(value.toObject()).toJson(QJsonDocument::Compact);
    if (value.isArray())
        return QJsonDocument(value.toArray()).toJson(QJsonDocument::Compact);
    const QByteArray wrapped = QJsonDocument(QJsonArray{value}).toJson(QJsonDocument::Compact);
    return wrapped.mid(1, wrapped.size() - 2);
}

std::optional<QString> findNonFinite(const QJsonValue &value) {
    if (value.isDouble())
        return std::isfinite(value.toDouble()) ? std::nullopt : std::optional<QString>(QString());
    const auto below = [](const QString &key, const QString &path) {
        return path.isEmpty() ? key : key + QLatin1Char('.') + path;
    };
    if (value.isArray()) {
        const QJsonArray array = value.toArray();
        for (int i = 0; i < array.size(); ++i) {
            if (const auto path = findNonFinite(array.at(i)))
                return below(QString::number(i), *path);
        }
    } else if (value.isObject()) {
        const QJsonObject object = value.toObject();
        for (auto member = object.begin(); member != object.end(); ++member) {
            if (const auto path = findNonFinite(member.value()))
                return below(member.key(), *path);
        }
    }
    return std::nullopt;
}

} // namespace hermes
