#include "gui/hermesctl/Completion.h"

#include "common/Project.h"
#include "common/client/DaemonAddress.h"
#include "common/schema/SchemaText.h"
#include "gui/hermesctl/CompletionScripts.h"
#include "gui/hermesctl/Descriptions.h"
#include "gui/hermesctl/Loggers.h"
#include "gui/hermesctl/Subcommands.h"
#include "gui/session/SessionRecorder.h"

#include <QJsonArray>

namespace hermes::ctl {
namespace {

constexpr std::chrono::milliseconds patience{400}; // with a connection, and with each reply

struct Candidate {
    QString text;
    QString meaning;
};
using Candidates = std::vector<Candidate>;

/// The words as the shell takes them, the last one is that before the cursor.
QStringList splitLine(const QString &line) {
    QStringList words{QString()};
    QChar quote;
    for (int i = 0; i < line.size(); ++i) {
        const QChar c = line[i];
        if (!quote.isNull() && c == quote)
            quote = QChar();
        else if (quote.isNull() && (c == QLatin1Char('"') || c == QLatin1Char('\'')))
            quote = c;
        else if (c == QLatin1Char('\\') && i + 1 < line.size() && quote != QLatin1Char('\''))
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

/// A command line that is being typed.
class Completion {
public:
    explicit Completion(const QString &line) {
        QStringList words = splitLine(line).mid(1);
        if (!words.isEmpty())
            current_ = words.takeLast();
        read(words);
    }

    Candidates candidates() {
        Candidates found;
        for (const Candidate &candidate : all())
            if (candidate.text.startsWith(current_) || candidate.text == QStringLiteral(":files"))
                found.push_back(candidate);
        return found;
    }

private:
    void read(const QStringList &words) {
        for (int i = 0; i < words.size(); ++i) {
            const QString &word = words[i];
            if (Arguments::optionsWithValue().contains(word)) {
                if (i + 1 == words.size())
                    pendingOption_ = word;
                else
                    take(word, words[++i]);
            } else if (word.startsWith(QLatin1Char('-'))) {
                take(word.section(QLatin1Char('='), 0, 0), word.section(QLatin1Char('='), 1));
            } else if (arguments_.command.isEmpty()) {
                arguments_.command = word;
            } else if (arguments_.command == QStringLiteral("record")) {
                arguments_.command += QLatin1Char(' ') + word;
            } else {
                arguments_.words.append(word);
            }
        }
    }

    void take(const QString &option, const QString &value) {
        if (option == QStringLiteral("--host"))
            arguments_.host = value;
        else if (option == QStringLiteral("--daemons"))
            arguments_.daemons = value.split(QLatin1Char(','));
    }

    Candidates all() {
        if (!pendingOption_.isEmpty())
            return ofOption(pendingOption_, QString());
        const int equals = current_.indexOf(QLatin1Char('='));
        if (current_.startsWith(QLatin1Char('-')))
            return equals > 0 ? ofOption(current_.left(equals), current_.left(equals + 1)) : options();
        if (arguments_.command.isEmpty())
            return commands(QString());
        if (arguments_.command == QStringLiteral("record"))
            return commands(QStringLiteral("record "));
        const Subcommand *const command = findSubcommand(arguments_.command);
        if (!command || arguments_.words.size() >= command->mostWords || command->words.empty())
            return {};
        const auto place = std::min(std::size_t(arguments_.words.size()), command->words.size() - 1);
        return ofWord(command->words[place]);
    }

    static Candidates commands(const QString &begin) {
        Candidates found;
        for (const Subcommand &one : subcommands()) {
            const QString name = QLatin1String(one.name);
            if (!begin.isEmpty() && !name.startsWith(begin))
                continue;
            const QString word = name.mid(begin.size()).section(QLatin1Char(' '), 0, 0);
            if (found.empty() || found.back().text != word)
                found.push_back({word, QLatin1String(one.summary)});
        }
        return found;
    }

    Candidates options() const {
        QStringList names{QStringLiteral("--help"), QStringLiteral("--host"), QStringLiteral("--timeout"),
                          QStringLiteral("--json"), QStringLiteral("--out"),  QStringLiteral("--force")};
        if (const Subcommand *command = findSubcommand(arguments_.command))
            names += QString::fromLatin1(command->options).split(QLatin1Char(' '), Qt::SkipEmptyParts);
        else
            names.append(QStringLiteral("--version"));
        return plain(names);
    }

    Candidates ofOption(const QString &option, const QString &before) const {
        if (option == QStringLiteral("--out"))
            return {{QStringLiteral(":files"), QString()}};
        if (option != QStringLiteral("--daemons"))
            return {};
        const QString given = current_.mid(before.size());
        const QString listed = given.left(given.lastIndexOf(QLatin1Char(',')) + 1);
        return plain(daemonNames(), before + listed);
    }

    static Candidates plain(const QStringList &texts, const QString &before = {}, const QString &after = {}) {
        Candidates found;
        for (const QString &text : texts)
            found.push_back({before + text + after, QString()});
        return found;
    }

    Candidates ofWord(Word word) {
        switch (word) {
        case Word::Nothing:
            return {};
        case Word::Daemon:
            return daemons();
        case Word::Method:
            return described(askList("rpc.discover", "methods"));
        case Word::Parameter:
            return parameters();
        case Word::SettingPath:
            return plain(settingPaths(ask("settings.schema").toObject(), true));
        case Word::SettingValue:
            return settings();
        case Word::Topic:
            return described(ask("topics.list").toArray());
        case Word::Session:
            return sessions();
        case Word::Shell:
            return plain(completionShells());
        }
        return {};
    }

    Candidates daemons() const {
        Candidates found;
        for (const QString &name : daemonNames()) {
            const QString address = *daemonAddress(name, arguments_.host);
            found.push_back({name, address});
            if (!current_.isEmpty()) // names first: who wants an address begins with it
                found.push_back({address, name});
        }
        return found;
    }

    /// null where the daemon does not answer.
    QJsonValue ask(const char *method) {
        if (!client_) {
            client_ = std::make_unique<Client>();
            const auto address = daemonAddress(arguments_.words.value(0), arguments_.host);
            if (address)
                (void)connectOnce(*client_, *address, patience);
        }
        if (!client_->isConnected())
            return {};
        const auto answer = client_->callAndWait(QLatin1String(method), QJsonObject(), patience);
        return answer ? *answer : QJsonValue();
    }

    QJsonArray askList(const char *method, const char *member) {
        return ask(method)[QLatin1String(member)].toArray();
    }

    static Candidates described(const QJsonArray &list) {
        Candidates found;
        for (const QJsonValue &one : list)
            found.push_back(
                {one[QStringLiteral("name")].toString(), one[QStringLiteral("summary")].toString()});
        return found;
    }

    /// NAME= of those that are not given yet; after it what the schema allows, or what there is of the kind.
    Candidates parameters() {
        const QString methodName = arguments_.words.value(1);
        const QJsonObject method = named(askList("rpc.discover", "methods"), methodName);
        const QStringList names = namesOf(method[QStringLiteral("params")].toArray());
        const QString name = current_.section(QLatin1Char('='), 0, 0);
        if (current_.contains(QLatin1Char('='))) {
            const QStringList there = whatThereIs(methodName, name);
            return there.isEmpty() ? values(name, parameterSchema(method, name))
                                   : plain(there, name + QLatin1Char('='));
        }
        Candidates found;
        for (const QString &one : names)
            if (!isGiven(one))
                found.push_back({one + QLatin1Char('='), explanation(parameterSchema(method, one))});
        return found;
    }

    QStringList whatThereIs(const QString &method, const QString &parameter) {
        const bool isName = parameter == QStringLiteral("name");
        if (parameter == QStringLiteral("recording") ||
            (isName && method.startsWith(QStringLiteral("record.")) &&
             method != QStringLiteral("record.start")))
            return namesOf(ask("record.list").toArray());
        if (isName && method.startsWith(QStringLiteral("process.")) &&
            method != QStringLiteral("process.add"))
            return namesOf(ask("process.list").toArray());
        return parameter == QStringLiteral("topic") ? namesOf(ask("topics.list").toArray()) : QStringList();
    }

    Candidates settings() {
        const QJsonObject schema = ask("settings.schema").toObject();
        const QString path = current_.section(QLatin1Char('='), 0, 0);
        if (current_.contains(QLatin1Char('=')))
            return values(path, settingSchema(schema, path));
        Candidates found;
        for (const QString &one : settingPaths(schema, false))
            if (!isGiven(one))
                found.push_back({one + QLatin1Char('='), explanation(settingSchema(schema, one))});
        return found;
    }

    bool isGiven(const QString &name) const {
        return std::any_of(arguments_.words.begin(), arguments_.words.end(),
                           [&name](const QString &word) { return word.startsWith(name + QLatin1Char('=')); });
    }

    static Candidates values(const QString &name, const QJsonObject &schema) {
        QStringList texts;
        for (const QJsonValue &choice : schema[QStringLiteral("enum")].toArray())
            texts.append(choice.isString() ? choice.toString() : shown(choice));
        if (schema[QStringLiteral("type")].toString() == QStringLiteral("boolean"))
            texts = QStringList{QStringLiteral("true"), QStringLiteral("false")};
        return plain(texts, name + QLatin1Char('='));
    }

    Candidates sessions() {
        arguments_.timeout = patience;
        const auto loggers = Loggers::find(arguments_);
        if (!loggers)
            return {};
        SessionRecorder recorder(loggers->members);
        const auto list = await<SessionList>([&](auto done) { recorder.list(0, done); });
        Candidates found;
        for (const RecordedSession &session : list.sessions)
            found.push_back({session.name, session.members().join(QStringLiteral(", "))});
        return found;
    }

    Arguments arguments_;
    QString current_;
    QString pendingOption_; ///< whose value is being typed
    std::unique_ptr<Client> client_;
};

} // namespace

int printCandidates(const QString &line) {
    QStringList known;
    for (const Candidate &candidate : Completion(line).candidates()) {
        if (known.contains(candidate.text))
            continue;
        known.append(candidate.text);
        printLine(candidate.text + QLatin1Char('\t') + candidate.meaning.simplified());
    }
    return 0;
}

Result<void> completion(const Arguments &arguments) {
    const QString script = completionScript(arguments.words.first());
    if (script.isEmpty())
        return Error(ErrorCode::InvalidParams,
                     QStringLiteral("there is no completion for \"%1\", expected one of %2")
                         .arg(arguments.words.first(), completionShells().join(QStringLiteral(", "))));
    if (arguments.json)
        printJson(script);
    else
        printLine(script.trimmed());
    return {};
}

} // namespace hermes::ctl
