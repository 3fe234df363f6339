#include "gui/desktop/panels/MapMenu.h"

#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QActionGroup>
#include <QDateTime>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QJsonArray>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

namespace hermes::desktop {
namespace {

constexpr int longestPath = 120, maxMaps = 200;

QDialog *makeDialog(QWidget *parent, const QString &title) {
    auto *const dialog = new QDialog(parent);
    dialog->setWindowTitle(title);
    new QVBoxLayout(dialog);
    return dialog;
}

QPushButton *addButtons(QDialog *dialog, const QString &accept) {
    auto *const buttons = new QDialogButtonBox(QDialogButtonBox::Cancel);
    QPushButton *const button = named(buttons->addButton(accept, QDialogButtonBox::AcceptRole), "accept");
    buttons->button(QDialogButtonBox::Cancel)->setAutoDefault(false);
    QObject::connect(buttons, &QDialogButtonBox::accepted, dialog, &QDialog::accept);
    QObject::connect(buttons, &QDialogButtonBox::rejected, dialog, &QDialog::reject);
    dialog->layout()->addWidget(buttons);
    button->setDefault(true);
    return button;
}

/// As a person knows it.
QString commandText(const QString &command) {
    return command == "map.clear"         ? MapMenu::tr("New map")
           : command == "map.load"        ? MapMenu::tr("Open")
           : command == "pose.set"        ? MapMenu::tr("Place")
           : command == "pose.relocalize" ? MapMenu::tr("Relocalize")
           : command == "replay"          ? MapMenu::tr("Replay")
                                          : shortLine(command);
}

/// "Undo Place".
void name(QAction *action, const QString &word, const QString &command) {
    action->setText(command.isEmpty() ? word : word + ' ' + commandText(command));
}

} // namespace

MapMenu::MapMenu(QWidget *parent)
    : QMenu(tr("Map"), parent) {
    setObjectName("map");
    setToolTipsVisible(true);
    add(tr("&New map"), "newMap", "map.clear", [this] { startNew(); });
    add(tr("&Open..."), "openMap", "map.load", [this] { open(); });
    save_ = add(tr("&Save"), "saveMap", "map.save", [this] { save(); });
    add(tr("Save &as..."), "saveMapAs", "map.save", [this] { saveAs(); });
    add(tr("&Export on the robot..."), "exportMap", "map.export", [this] { exportAs(); });
    undo_ = add(tr("&Undo"), "undoMap", "map.undo", [this] { undo(false); });
    redo_ = add(tr("&Redo"), "redoMap", "map.undo", [this] { undo(true); });
    confirm_ = add(tr("&Confirm the place..."), "confirmPlace", "pose.set", [this] { confirm(); });
    addSeparator();
    mapping_ = add(tr("&Mapping: the map grows"), "mapping", "matcher.start", [this] { setMode("mapping"); });
    localization_ = add(tr("&Localization: the map stays as it is"), "localization", "matcher.start",
                        [this] { setMode("localization"); });
    auto *const modes = new QActionGroup(this);
    for (QAction *const mode : {mapping_, localization_}) {
        mode->setCheckable(true);
        modes->addAction(mode);
    }
    connect(this, &QMenu::aboutToShow, this, &MapMenu::readMode);
    update();
}

QAction *MapMenu::add(const QString &text, const char *name, const char *method,
                      const std::function<void()> &work) {
    QAction *const action = named(addAction(text, this, work), name);
    actions_.emplace_back(action, method);
    return action;
}

void MapMenu::setMatcher(DaemonLink *matcher) {
    if (matcher_ != matcher) {
        path_.clear();
        matcher_ = matcher;
        name(undo_, tr("&Undo"), {});
        name(redo_, tr("&Redo"), {});
        question_.close();
        Q_EMIT told({}, false);
    }
    update();
}

void MapMenu::update() {
    for (const auto &[action, method] : actions_) {
        const bool isThere = matcher_ && matcher_->isConnected();
        action->setEnabled(isThere && matcher_->may(method));
        action->setToolTip(isThere ? matcher_->refusal(method) : tr("No scan matcher is connected."));
    }
    save_->setText(path_.isEmpty() ? tr("&Save") : tr("&Save %1").arg(shortLine(path_, longestPath)));
}

void MapMenu::call(const QString &method, const QJsonObject &params, const Then &then) {
    if (!matcher_)
        return Q_EMIT told(tr("No scan matcher is connected."), true);
    Q_EMIT told(tr("Waiting for the scan matcher ..."), false);
    matcher_->callForMuch(method, params, this,
                          [this, then, asked = matcher_](const Result<QJsonValue> &result) {
                              if (asked != matcher_)
                                  return; // another robot's answer
                              if (result)
                                  then(*result);
                              else
                                  Q_EMIT told(result.error().message, true);
                          });
}

void MapMenu::ask(const QString &question, const QString &yes, const std::function<void()> &work) {
    question_.ask(parentWidget(), tr("Map"), question, yes, work);
}

void MapMenu::startNew() {
    ask(tr("Begin a new map? The one of now is kept: Map, Undo. The drive that closes its loops is not."),
        tr("Begin anew"), [this] {
            call("map.clear", {}, [this](const QJsonValue &) {
                path_.clear();
                update();
                Q_EMIT told(tr("A new map has begun. Map, Undo brings back the last that had walls, if there "
                               "is one."),
                            false);
            });
        });
}

void MapMenu::open() {
    call("map.list", {}, [this](const QJsonValue &list) {
        Q_EMIT told({}, false);
        QDialog *const dialog = makeDialog(parentWidget(), tr("Open a map of the robot"));
        auto *const maps = named(new QTreeWidget, "maps");
        maps->setHeaderLabels({tr("Map"), tr("Written"), tr("KiB")});
        maps->setRootIsDecorated(false);
        int count = 0;
        for (const QJsonValue &map : list["maps"].toArray()) {
            if (++count > maxMaps)
                break;
            const auto time = timeOf(map["modified"].toDouble());
            const QString kind = map["journal"].toBool() ? tr(" (a drive, goes on)") : QString();
            auto *const item =
                new QTreeWidgetItem(maps, {shortLine(map["path"].toString(), longestPath) + kind,
                                           time ? time->toString("yyyy-MM-dd HH:mm") : QString(),
                                           shortNumber(map["bytes"].toDouble() / 1024, 0)});
            item->setData(0, Qt::UserRole, map["path"].toString());
        }
        maps->header()->setStretchLastSection(false);
        maps->header()->setSectionResizeMode(QHeaderView::ResizeToContents);
        maps->header()->setSectionResizeMode(0, QHeaderView::Stretch);
        maps->setCurrentItem(maps->topLevelItem(0));
        dialog->layout()->addWidget(maps);
        QPushButton *const accept = addButtons(dialog, tr("Open"));
        accept->setEnabled(maps->topLevelItemCount() > 0);
        connect(maps, &QTreeWidget::itemDoubleClicked, dialog, &QDialog::accept);
        connect(dialog, &QDialog::accepted, this, [this, maps] {
            if (const QTreeWidgetItem *const item = maps->currentItem())
                load(item->data(0, Qt::UserRole).toString());
        });
        dialog->resize(560, 320);
        question_.show(dialog);
    });
}

void MapMenu::load(const QString &path) {
    call("map.load", {{"path", path}}, [this, path](const QJsonValue &loaded) {
        path_ = path.endsWith(".csv") ? path : QString();
        update();
        const QString opened =
            tr("Opened %1: %2 walls. Map, Undo brings back the last that had walls, if there is one.")
                .arg(shortLine(path, longestPath))
                .arg(loaded["segments"].toDouble());
        Q_EMIT told(opened + ' ' + tr("The robot is sought in it; until it is found nothing is mapped."),
                    false);
        Q_EMIT sought(opened);
    });
}

void MapMenu::askName(const QString &title, const QString &name,
                      const std::function<void(const QString &)> &use) {
    QDialog *const dialog = makeDialog(parentWidget(), title);
    auto *const field = named(new QLineEdit(name), "mapName",
                              tr("Below the folder of maps on the robot (setting map.folder)"));
    dialog->layout()->addWidget(field);
    QPushButton *const accept = addButtons(dialog, tr("Write"));
    connect(field, &QLineEdit::textChanged, accept,
            [accept](const QString &text) { accept->setEnabled(!text.trimmed().isEmpty()); });
    connect(field, &QLineEdit::returnPressed, accept, &QPushButton::click);
    connect(dialog, &QDialog::accepted, this, [field, use] { use(field->text().trimmed()); });
    dialog->resize(420, 80);
    question_.show(dialog);
}

/// Asks again where the file exists.
void MapMenu::write(const QString &method, QJsonObject params) {
    if (!matcher_)
        return Q_EMIT told(tr("No scan matcher is connected."), true);
    const QString path = params["path"].toString();
    matcher_->call(method, params, this, [=, asked = matcher_](const Result<QJsonValue> &done) {
        if (asked != matcher_)
            return;
        if (!done && done.error().is(ErrorCode::InputOutput) && !params.contains("force") &&
            done.error().message.contains("exists")) {
            ask(tr("%1 exists on the robot. Replace it?").arg(shortLine(path, longestPath)), tr("Replace"),
                [=]() mutable {
                    params["force"] = true;
                    write(method, params);
                });
            return;
        }
        if (!done)
            return Q_EMIT told(done.error().message, true);
        if (method == "map.save")
            path_ = path;
        update();
        Q_EMIT told(tr("Wrote %1 walls to %2 on the robot")
                        .arg((*done)["segments"].toDouble())
                        .arg(shortLine((*done)["path"].toString(), longestPath)),
                    false);
    });
}

void MapMenu::save() {
    const QString time = QDateTime::currentDateTime().toString("yyyy-MM-dd-HHmmss");
    write("map.save", {{"path", path_.isEmpty() ? "map-" + time + ".csv" : path_}}); // asks where it exists
}

void MapMenu::saveAs() {
    askName(tr("Save the map on the robot"), path_.isEmpty() ? "map.csv" : path_,
            [this](const QString &name) {
                write("map.save", {{"path", name.contains('.') ? name : name + ".csv"}});
            });
}

void MapMenu::exportAs() {
    askName(tr("Export the map on the robot: .svg, .dxf, .geojson or .csv"), "map.svg",
            [this](const QString &name) {
                const QString format = name.section('.', -1).toLower();
                if (!QStringList{"svg", "dxf", "geojson", "csv"}.contains(format))
                    return Q_EMIT told(tr("%1: expected .svg, .dxf, .geojson or .csv").arg(shortLine(name)),
                                       true);
                write("map.export", {{"path", name}, {"format", format}});
            });
}

void MapMenu::undo(bool again) {
    call("map.undo", again ? QJsonObject{{"redo", true}} : QJsonObject(),
         [this, again](const QJsonValue &back) {
             const bool isMap = back["map"].toBool(), isPose = back["pose"].toBool();
             if (isMap)
                 path_.clear();
             readMode();
             QString brought = again ? tr("Done again: %1.") : tr("Undone: %1.");
             brought = brought.arg(commandText(back["command"].toString()));
             if (isMap)
                 brought += ' ' + tr("The map has %1 walls.").arg(back["segments"].toDouble());
             if (isPose)
                 return Q_EMIT told(
                     brought + ' ' + tr("Its place counts once scans agree, or a second search confirms it."),
                     false);
             Q_EMIT told(brought + ' ' + tr("The robot is sought in it."), false);
             Q_EMIT sought(brought);
         });
}

void MapMenu::confirm() {
    ask(tr("Is the robot really where the map shows it, and does it stand? What it sees is drawn there from "
           "now on, whatever the scans say."),
        tr("It is there"), [this] { Q_EMIT confirmed(); });
}

void MapMenu::setMode(const QString &mode) {
    call("matcher.start", {{"mode", mode}}, [this, mode](const QJsonValue &) {
        question_.close();
        Q_EMIT told(mode == "mapping" ? tr("The map grows.") : tr("The map stays as it is."), false);
        readMode();
    });
}

void MapMenu::readMode() {
    update();
    if (!matcher_)
        return;
    matcher_->call("matcher.state", {}, this, [this](const Result<QJsonValue> &state) {
        if (!state)
            return;
        mapping_->setChecked((*state)["mode"] == QJsonValue("mapping"));
        localization_->setChecked((*state)["mode"] == QJsonValue("localization"));
        name(undo_, tr("&Undo"), (*state)["undoes"].toString());
        name(redo_, tr("&Redo"), (*state)["redoes"].toString());
        if ((*state)["place"] == QJsonValue("known")) {
            confirm_->setEnabled(false);
            confirm_->setToolTip(tr("The place of the robot in the map is known."));
        }
    });
}

} // namespace hermes::desktop
