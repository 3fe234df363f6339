#include "gui/desktop/panels/MapPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/MapMenu.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QMenu>
#include <QToolBar>
#include <QToolButton>
#include <QtMath>

namespace hermes::desktop {

MapPanel::MapPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , model_(fleet)
    , view_(named(new MapView(model_), "map"))
    , map_(new MapMenu(this))
    , message_(new MessageLabel) {
    auto *const bar = new QToolBar;
    bar->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    bar->setIconSize({16, 16});
    addMap(*bar);
    addTools(*bar);
    addLayers(*bar);
    for (auto *const button : bar->findChildren<QToolButton *>())
        button->setFocusPolicy(Qt::TabFocus); // within reach of the keyboard
    message_->setMargin(4);
    filled(this, inColumn({bar, {view_, 1}, message_}), 0);
    setFocusProxy(view_);

    connect(&fleet, &Fleet::changed, this, &MapPanel::updateTools);
    connect(&fleet, &Fleet::robotChosen, this, [this] { // what was begun there is not to go on here
        view_->setTool(MapView::Tool::Pan);
        message_->hide();
        updateTools();
    });
    connect(view_, &MapView::followingChanged, follow_, &QAction::setChecked);
    connect(view_, &MapView::fittingChanged, fit_, &QAction::setChecked);
    connect(view_, &MapView::toolChanged, this, &MapPanel::updateTools);
    connect(view_, &MapView::measured, this,
            [this](double distance) { message_->tell(tr("%1 m").arg(distance, 0, 'f', 3)); });
    connect(view_, &MapView::placed, this, [this](const Pose2D &pose) {
        ask("pose.set", {{"x", pose.x}, {"y", pose.y}, {"theta", pose.theta}},
            tr("Placed at %1 m, %2 m, %3°")
                .arg(pose.x, 0, 'f', 2)
                .arg(pose.y, 0, 'f', 2)
                .arg(qRadiansToDegrees(pose.theta), 0, 'f', 0));
    });
    updateTools();
}

void MapPanel::addMap(QToolBar &bar) {
    map_->addAction(theme::icon("export"), tr("Export the &view..."), this, &MapPanel::askFile)
        ->setObjectName("export");
    bar.addWidget(named(menuButton(tr("Map"), theme::icon("save"), map_), "mapMenu"));
    connect(map_, &MapMenu::told, this, [this](const QString &text, bool isError) {
        if (text.isEmpty())
            message_->hide();
        else
            message_->tell(text, isError);
    });
    connect(&model_, &MapModel::replaced, map_, &MapMenu::endQuestion);
    connect(map_, &MapMenu::sought, this, [this](const QString &text) {
        sought_ = {message_->text(), text};
    });
    connect(map_, &MapMenu::confirmed, this, [this] {
        if (const std::optional<Pose2D> pose = model_.pose())
            ask("pose.set", {{"x", pose->x}, {"y", pose->y}, {"theta", pose->theta}, {"confirm", true}},
                tr("The place is confirmed. Map, Undo takes it back."));
        else
            message_->tell(tr("The scan matcher has told no pose as yet."), true);
    });
    connect(&model_, &MapModel::changed, this, &MapPanel::tellFound);
}

/// Unless something else was told meanwhile.
void MapPanel::tellFound() {
    if (sought_.first.isEmpty() || !model_.pose() || model_.outcome() != "matched")
        return;
    const auto [sought, found] = std::exchange(sought_, {});
    if (!message_->isHidden() && message_->text() == sought)
        message_->tell(found + ' ' + tr("The robot was found in it."));
}

QMenu &MapPanel::mapMenu() {
    return *map_;
}

void MapPanel::addTools(QToolBar &bar) {
    // "Follow\tF" is "Follow" on its button, and has its key beside it in a menu.
    const auto add = [&](const char *icon, const QString &text, const QString &toolTip, bool isCheckable) {
        QAction *const action = bar.addAction(theme::icon(QString(icon)), text);
        named(action, icon, toolTip)->setIconText(text.section('\t', 0, 0));
        action->setCheckable(isCheckable);
        return action;
    };
    follow_ = add("follow", tr("Follow") + "\tF", tr("Keeps the robot in the middle (F)"), true);
    follow_->setChecked(view_->isFollowing());
    connect(follow_, &QAction::toggled, view_, &MapView::setFollowing);
    fit_ = add("fit", tr("Fit") + "\t0", tr("Shows the whole map, also while it grows (0)"), true);
    connect(fit_, &QAction::toggled, view_, &MapView::setFitting);
    measure_ = add("measure", tr("Measure"), tr("Drag from one point to another"), true);
    place_ = add("place", tr("Place"), tr("Press where the robot is and drag to where it looks"), true);
    const auto choose = [this](MapView::Tool tool) {
        return [this, tool](bool isOn) { view_->setTool(isOn ? tool : MapView::Tool::Pan); };
    };
    connect(measure_, &QAction::triggered, this, choose(MapView::Tool::Measure));
    connect(place_, &QAction::triggered, this, choose(MapView::Tool::Place));
    relocalize_ = add("relocalize", tr("Relocalize"), tr("Finds the robot in the whole map"), false);
    connect(relocalize_, &QAction::triggered, this,
            [this] { ask("pose.relocalize", {}, tr("Found the robot in the map")); });
}

void MapPanel::addLayers(QToolBar &bar) {
    auto *const menu = layers_ = named(new QMenu(tr("Layers"), this), "layers");
    const auto add = [&](const char *key, const QString &name, bool MapLayers::*layer) {
        QAction *const action = named(menu->addAction(name), key); // by which layouts keep it
        action->setCheckable(true);
        action->setChecked(view_->layers().*layer);
        connect(action, &QAction::toggled, this, [this, layer](bool isOn) {
            view_->layers().*layer = isOn;
            view_->update();
        });
    };
    add("gridLayer", tr("Grid"), &MapLayers::grid);
    add("mapLayer", tr("Map"), &MapLayers::map);
    add("scanLayer", tr("Scan points"), &MapLayers::scan);
    add("segmentsLayer", tr("Segments of the scan"), &MapLayers::segments);
    add("correspondencesLayer", tr("Correspondences"), &MapLayers::correspondences);
    add("pathLayer", tr("Path as matched (solid)"), &MapLayers::path);
    add("odometryLayer", tr("Path by odometry (dashed)"), &MapLayers::odometry);
    add("truthLayer", tr("True path (dotted; the simulator knows it)"), &MapLayers::truth);
    add("robotLayer", tr("Robot"), &MapLayers::robot);
    add("uncertaintyLayer", tr("Uncertainty of the pose (ten times enlarged)"), &MapLayers::uncertainty);
    add("numbersLayer", tr("Pose and match in numbers"), &MapLayers::numbers);
    add("loopsLayer", tr("Loops (places met again; those refused dashed)"), &MapLayers::loops);
    add("graphLayer", tr("Graph (key scans of the drive)"), &MapLayers::graph);
    add("trustLayer", tr("Trust (how well the drive is known)"), &MapLayers::trust);
    menu->addSeparator();
    menu->addAction(tr("Clear paths"), &model_, &MapModel::clearPaths);
    bar.addWidget(menuButton(tr("Layers"), theme::icon("layers"), menu));
}

QVariantMap MapPanel::layers() const {
    QVariantMap ticks;
    for (const QAction *const action : layers_->actions())
        if (action->isCheckable())
            ticks[action->objectName()] = action->isChecked();
    return ticks;
}

void MapPanel::setLayers(const QVariantMap &ticks) {
    for (QAction *const action : layers_->actions())
        if (ticks.contains(action->objectName()))
            action->setChecked(ticks[action->objectName()].toBool());
}

void MapPanel::askFile() {
    askForFile(export_, this, tr("Export the view"), "map.svg", tr("Pictures (*.svg *.png)"),
               [this](const QString &file) {
                   writeBeside(drawn(file), this, [this, file](const Result<void> &done) {
                       message_->tell(done ? tr("Wrote %1").arg(file) : done.error().message, !done);
                   });
               });
}

Writing MapPanel::drawn(const QString &file) const {
    return picture(file, tr("Hermes map"), view_->size(),
                   [this](QPainter &painter) { view_->render(painter); });
}

void MapPanel::ask(const QString &method, const QJsonObject &params, const QString &done) {
    DaemonLink *const matcher = model_.matcher();
    if (!matcher)
        return message_->tell(tr("No scan matcher is connected."), true);
    message_->tell(tr("Waiting for the scan matcher ..."));
    matcher->call(method, params, this, [this, matcher, done](const Result<QJsonValue> &result) {
        if (matcher == model_.matcher())
            message_->tell(result ? done : result.error().message, !result);
    });
}

void MapPanel::updateTools() {
    const DaemonLink *const matcher = model_.matcher();
    const bool isThere = matcher && matcher->isConnected();
    map_->setMatcher(model_.matcher());
    measure_->setChecked(view_->tool() == MapView::Tool::Measure);
    place_->setChecked(view_->tool() == MapView::Tool::Place);
    place_->setEnabled(isThere && matcher->may("pose.set"));
    relocalize_->setEnabled(isThere && matcher->may("pose.relocalize"));
}

} // namespace hermes::desktop
