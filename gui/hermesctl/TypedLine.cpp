#include "gui/hermesctl/TypedLine.h"

#include <algorithm>

namespace hermes::ctl {
namespace {

/// The words as the shell takes them, the last one is that before the cursor.
QStringList splitLine(const QString &line) {
    QStringList words{QString()};
    QChar quote;
    for (int i = 0; i < line.size(); ++i) {
        const QChar c = line[i];
        if (!quote.isNull() && c == quote)
            quote = QChar();
        else if (quote.isNull() && (c == '"' || c == '\''))
            quote = c;
        else if (c == '\\' && i + 1 < line.size() && quote != '\'')
            words.last() += line[++i];
        else if (quote.isNull() && c.isSpace())
            words.append(QString());
        else
            words.last() += c;
    }
    const QString last = words.takeLast();
    words.removeAll(QString());
    return words << last;
}

} // namespace

TypedLine TypedLine::read(const QString &line) {
    TypedLine result;
    QStringList words = splitLine(line).mid(1);
    if (!words.isEmpty())
        result.current = words.takeLast();
    for (int i = 0; i < words.size(); ++i) {
        const QString &word = words[i];
        const Option *const option = findOption(word.section('=', 0, 0));
        if (!word.startsWith('-'))
            result.arguments.takeWord(word);
        else if (!option)
            continue;
        else if (!option->hasValue() || word.contains('='))
            option->take(result.arguments, word.section('=', 1));
        else if (i + 1 == words.size())
            result.pendingOption = word;
        else
            option->take(result.arguments, words[++i]);
    }
    return result;
}

bool TypedLine::isGiven(const QString &name) const {
    return std::any_of(arguments.words.begin(), arguments.words.end(),
                       [&name](const QString &word) { return word.startsWith(name + '='); });
}

} // namespace hermes::ctl
