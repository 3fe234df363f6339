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

void take(Arguments &arguments, const QString &option, const QString &value) {
    if (option == "--host")
        arguments.host = value;
    else if (option == "--daemons")
        arguments.daemons = value.split(',');
}

void takeWord(Arguments &arguments, const QString &word) {
    if (arguments.command.isEmpty())
        arguments.command = word;
    else if (hasSecondWord(arguments.command))
        arguments.command += ' ' + word;
    else
        arguments.words.append(word);
}

} // namespace

TypedLine TypedLine::read(const QString &line) {
    TypedLine result;
    QStringList words = splitLine(line).mid(1);
    if (!words.isEmpty())
        result.current = words.takeLast();
    for (int i = 0; i < words.size(); ++i) {
        const QString &word = words[i];
        if (!word.startsWith('-'))
            takeWord(result.arguments, word);
        else if (!Arguments::optionsWithValue().contains(word))
            take(result.arguments, word.section('=', 0, 0), word.section('=', 1));
        else if (i + 1 == words.size())
            result.pendingOption = word;
        else
            take(result.arguments, word, words[++i]);
    }
    return result;
}

bool TypedLine::isGiven(const QString &name) const {
    return std::any_of(arguments.words.begin(), arguments.words.end(),
                       [&name](const QString &word) { return word.startsWith(name + '='); });
}

} // namespace hermes::ctl
