#include "gui/hermesctl/Completion.h"

#include "common/Project.h"
#include "common/Role.h"
#include "common/client/DaemonAddress.h"
#include "common/schema/SchemaText.h"
#include "gui/hermesctl/Commands.h"
#include "gui/hermesctl/Descriptions.h"
#include "gui/hermesctl/Hosts.h"
#include "gui/hermesctl/Subcommands.h"
#include "protocol/messages/Setup.h"

#include <QJsonArray>
#include <algorithm>

namespace hermes::ctl {
namespace {

constexpr std::chrono::milliseconds promptTimeout{400}; // with a connection, and with each reply

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

/// A command line that is being typed, as far as it goes: from the program's name to the cursor.
struct TypedLine {
    Arguments arguments;   ///< of the words before the last one; only what says whom to ask
    QString current;       ///< the last word, begun or empty
    QString pendingOption; ///< whose value it is, where the option is a word of its own

    static TypedLine read(const QString &line) {
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

    /// NAME=VALUE stands there.
    bool isGiven(const QString &name) const {
        return std::any_of(arguments.words.begin(), arguments.words.end(),
                           [&name](const QString &word) { return word.startsWith(name + '='); });
    }
};

struct Candidate {
    QString text;
    QString meaning;
};
using Candidates = std::vector<Candidate>;

/// What may follow in a command line that is being typed.
class Completion {
public:
    explicit Completion(const QString &text)
        : line_(TypedLine::read(text)) {}

    Candidates candidates() {
        Candidates found;
        for (const Candidate &candidate : all())
            if (candidate.text.startsWith(line_.current) || candidate.text == ":files")
                found.push_back(candidate);
        return found;
    }

private:
    Candidates all() {
        if (!line_.pendingOption.isEmpty())
            return ofOption(line_.pendingOption, QString());
        const int equals = line_.current.indexOf('=');
        if (line_.current.startsWith('-'))
            return equals > 0 ? ofOption(line_.current.left(equals), line_.current.left(equals + 1))
                              : options();
        if (line_.arguments.command.isEmpty())
            return commands(QString());
        if (!subcommandNames(line_.arguments.command).isEmpty())
            return commands(line_.arguments.command + ' ');
        const Subcommand *const command = findSubcommand(line_.arguments.command);
        return command ? ofWord(command->meaning(line_.arguments.words.size())) : Candidates();
    }

    static Candidates commands(const QString &begin) {
        Candidates found;
        for (const Subcommand &one : subcommands()) {
            const QString word = one.name().mid(begin.size()).section(' ', 0, 0);
            if (one.name().startsWith(begin) && (found.empty() || found.back().text != word))
                found.push_back({word, one.summary});
        }
        return found;
    }

    Candidates options() const {
        QStringList names = commonOptions();
        if (const Subcommand *command = findSubcommand(line_.arguments.command))
            names += command->options();
        else
            names.append("--version");
        return plain(names);
    }

    Candidates ofOption(const QString &option, const QString &before) const {
        if (option == "--out")
            return {{":files", QString()}};
        if (option == "--host")
            return plain(knownHosts(promptTimeout), before);
        if (option == "--role")
            return plain(roleNames() + QStringList(PeerCertificate::daemonRole()), before);
        if (option == "--format")
            return plain({"csv", "tum", "carmen", "mcap", "pcap"}, before);
        if (option == "--profile")
            return plain({"ros2"}, before);
        if (option == "--base" && line_.arguments.command == "simulate")
            return plain(FoundSerial::controllerKinds(), before);
        if (option == "--kinematics")
            return plain(kinematicsOf(line_.arguments.base), before);
        if (option == "--recorder" || option == "--base")
            return daemons(before);
        if (option != "--daemons" && option != "--without")
            return {};
        const QString given = line_.current.mid(before.size());
        const QString listed = given.left(given.lastIndexOf(',') + 1);
        return plain(daemonNames(), before + listed);
    }

    static Candidates plain(const QStringList &texts, const QString &before = {}) {
        Candidates found;
        for (const QString &text : texts)
            found.push_back({before + text, QString()});
        return found;
    }

    /// word is one of the usage of a command.
    Candidates ofWord(const QString &word) {
        if (word == "D")
            return daemons();
        if (word == "METHOD")
            return described(askList("rpc.discover", "methods"));
        if (word == "NAME=VALUE")
            return parameters();
        if (word == "PATH")
            return plain(settingPaths(ask("settings.schema").toObject(), true));
        if (word == "PATH=VALUE")
            return assignments(ask("settings.schema").toObject());
        if (word == "TOPIC")
            return described(ask("topics.list").toArray());
        if (word == "SESSION")
            return sessions();
        if (word == "BAG")
            return {{":files", QString()}};
        if (word == "SAMPLE")
            return samples();
        if (word.endsWith('='))
            return velocities();
        return word.contains('|') ? plain(word.split('|')) : Candidates();
    }

    Candidates daemons(const QString &before = {}) const {
        Candidates found;
        for (const QString &name : daemonNames()) {
            const QString address = *daemonAddress(name, line_.arguments.host);
            found.push_back({before + name, address});
            if (line_.current.size() > before.size()) // names first: who wants an address begins with it
                found.push_back({before + address, name});
        }
        return found;
    }

    /// null where the daemon does not answer.
    QJsonValue ask(const char *method) {
        if (!client_) {
            client_ = std::make_unique<Client>();
            const auto address = daemonAddress(line_.arguments.words.value(0), line_.arguments.host);
            if (address)
                (void)connectOnce(*client_, *address, promptTimeout);
        }
        if (!client_->isConnected())
            return {};
        const auto answer = client_->callAndWait(method, QJsonObject(), promptTimeout);
        return answer ? *answer : QJsonValue();
    }

    QJsonArray askList(const char *method, const char *member) { return ask(method)[member].toArray(); }

    static Candidates described(const QJsonArray &list) {
        Candidates found;
        for (const QJsonValue &one : list)
            found.push_back({one["name"].toString(), one["summary"].toString()});
        return found;
    }

    Candidates parameters() {
        const QString methodName = line_.arguments.words.value(1);
        const QString name = line_.current.section('=', 0, 0);
        const QStringList there = line_.current.contains('=') ? whatThereIs(methodName, name) : QStringList();
        return there.isEmpty()
                   ? assignments(parametersSchema(named(askList("rpc.discover", "methods"), methodName)))
                   : plain(there, name + '=');
    }

    QStringList whatThereIs(const QString &method, const QString &parameter) {
        const bool isName = parameter == "name";
        if (isName && method.startsWith("session.") && method != "session.start")
            return namesOf(ask("session.list").toArray());
        if (parameter == "recording" || (isName && method.startsWith("record.") && method != "record.start"))
            return namesOf(ask("record.list").toArray());
        if (isName && method.startsWith("process.") && method != "process.add")
            return namesOf(ask("process.list").toArray());
        return parameter == "topic" ? namesOf(ask("topics.list").toArray()) : QStringList();
    }

    /// NAME= of those that are not given yet; after it what the schema allows.
    Candidates assignments(const QJsonObject &schema) const {
        const QString path = line_.current.section('=', 0, 0);
        if (line_.current.contains('='))
            return values(path, settingSchema(schema, path));
        Candidates found;
        for (const QString &one : settingPaths(schema, false))
            if (!line_.isGiven(one))
                found.push_back({one + '=', explanation(settingSchema(schema, one))});
        return found;
    }

    Candidates samples() {
        line_.arguments.words = QStringList(line_.arguments.daemons.value(0, "supervisor"));
        return plain(ask("setup.samples").toVariant().toStringList());
    }

    Candidates velocities() const {
        Candidates found;
        for (const QString &name : velocityNames())
            if (!line_.isGiven(name))
                found.push_back({name + '=', name.startsWith('v') ? "m/s" : "rad/s"});
        return found;
    }

    static Candidates values(const QString &name, const QJsonObject &schema) {
        QStringList texts;
        for (const QJsonValue &choice : schema["enum"].toArray())
            texts.append(choice.isString() ? choice.toString() : shown(choice));
        if (schema["type"].toString() == "boolean")
            texts = QStringList{"true", "false"};
        return plain(texts, name + '=');
    }

    Candidates sessions() {
        line_.arguments.words = QStringList(line_.arguments.recorder);
        Candidates found;
        for (const QJsonValue &session : ask("session.list").toArray())
            found.push_back(
                {session["name"].toString(), session["daemons"].toVariant().toStringList().join(", ")});
        return found;
    }

    TypedLine line_;
    std::unique_ptr<Client> client_;
};

/// A shell takes it for one word and nothing else, whoever has chosen the name.
QString quotedForShell(const QString &text) {
    const QString plain = "_-./:=,@%+";
    QString quoted;
    for (const QChar c : text) {
        if (!c.isLetterOrNumber() && !c.isSurrogate() && !plain.contains(c))
            quoted += '\\';
        quoted += c;
    }
    return quoted;
}

} // namespace

int printCandidates(const QString &line) {
    QStringList known;
    for (const Candidate &candidate : Completion(line).candidates()) {
        if (known.contains(candidate.text))
            continue;
        known.append(candidate.text);
        if (printable(candidate.text) == candidate.text) // nobody could type the others
            printLine(quotedForShell(candidate.text) + '\t' + printable(candidate.meaning.simplified()));
    }
    return 0;
}

} // namespace hermes::ctl
