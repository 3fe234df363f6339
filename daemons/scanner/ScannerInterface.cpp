// What the scanner offers: its settings, topics and commands.
#include "common/interface/InterfaceRegistry.h"
#include "daemons/scanner/Scanner.h"
#include "protocol/wire/Fields.h"

namespace hermes::scanner {

void Scanner::declareSettings() {
    QStringList models{"auto"};
    for (const scan::ScannerModel &model : scan::scannerModels())
        models.append(model.name);
    addSetting(Field::text("scanner.url",
                           "Where it is: serial:///dev/serial/by-id/NAME, with ?baud=RATE only if "
                           "that is not the model's; tcp://HOST:PORT")
                   .byDefault("")
                   .appliesOnRestart()
                   .group("Scanner"));
    addSetting(Field::text("scanner.model", "Which it is; auto: whichever is heard or answers on that line")
                   .choices(models)
                   .byDefault("auto")
                   .appliesOnRestart()
                   .group("Scanner"));
    settings().addRule([](const QJsonObject &values) -> std::vector<SchemaViolation> {
        const QString text = values["scanner"].toObject()["url"].toString();
        const Result<InterfaceUrl> url = InterfaceUrl::parse(text);
        const bool fits = url && ((url->scheme == "serial" && !url->path.isEmpty()) ||
                                  (url->scheme == "tcp" && !url->host.isEmpty() && url->port != 0));
        const QString model = values["scanner"].toObject()["model"].toString();
        const scan::ScannerModel *const told = scan::findScannerModel(model.toStdString());
        if (fits && told && url->scheme == "serial" && told->baud == 0)
            return {{"scanner.url", text, "tcp://HOST:PORT, as a " + model + " has no serial line"}};
        if (text.isEmpty() || fits)
            return {};
        return {{"scanner.url", text, "serial:///DEVICE or tcp://HOST:PORT, or nothing"}};
    });
    for (const Field &field : Recording::settingFields())
        addSetting(field);
    settings().addRule(Recording::checkSettings);
}

void Scanner::declareTopics() {
    addTopic(Topic("scan2d", "Each revolution: its points, counter-clockwise, in the scanner's frame")
                 .carries<ScanMessage>());
    addTopic(Topic("scanner", "State of source, scanner and recording, once a second")
                 .carries<ScannerMessage>()
                 .snapshot([this] { return state(); }));
}

void Scanner::declareCommands() {
    addCommand(source_.openCommand("Shows what the scanner measures, or a recording; the scanner is read and "
                                   "recorded all the same"));
    addCommand(source_.seekCommand());
    addCommand(source_.speedCommand());
    addCommand(source_.pauseCommand());
    addCommand(Command("source.status", "What the topic scanner says, now")
                   .needs(Role::Observer)
                   .answers([this](const Call &) { return state(); }));
    for (const Command &command : recording_.commands())
        addCommand(command);
    connect(&recording_, &Recording::changed, this,
            [this] { publish("scanner", [this] { return state(); }); });
}

} // namespace hermes::scanner
