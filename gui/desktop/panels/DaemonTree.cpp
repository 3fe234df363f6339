#include "gui/desktop/panels/DaemonTree.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/ForeignText.h"

#include <QContextMenuEvent>
#include <QHeaderView>
#include <QMenu>

namespace hermes::desktop {
namespace {

enum DaemonColumn { NameColumn, StateColumn };
constexpr int conditionRole = Qt::UserRole + 1; // whose icon and colour stand there: to set them costs

constexpr int longestWord = 20, maxHealthItems = 50, iconRoom = 34;

Condition conditionOf(const QString &level) {
    return level == "ok" ? Condition::Ready : level == "error" ? Condition::Fault : Condition::Warning;
}

void setText(QTreeWidgetItem &item, const QString &name, const QString &state, Condition condition,
             const QString &toolTip) {
    item.setText(NameColumn, name);
    item.setText(StateColumn, state);
    if (const QVariant now = int(condition); item.data(StateColumn, conditionRole) != now) {
        item.setData(StateColumn, conditionRole, now);
        item.setIcon(StateColumn, theme::icon(condition));
        item.setForeground(StateColumn, theme::colour(condition));
    }
    for (const DaemonColumn column : {NameColumn, StateColumn})
        item.setToolTip(column, toolTipOf(toolTip));
}

/// What the supervisor says of a process: share of a core, memory, restarts.
QString usage(const ProcessStatus *process) {
    if (!process || process->pid == 0)
        return {};
    return DaemonTree::tr("%1 % of a core, %2 MB, %3 restarts")
        .arg(shortNumber(100 * process->cpu.value_or(0), 1),
             shortNumber(double(process->memory_bytes.value_or(0)) / 1e6, 1))
        .arg(process->restarts);
}

DaemonLink *daemonIn(const QTreeWidgetItem &row) {
    return qobject_cast<DaemonLink *>(row.data(NameColumn, Qt::UserRole).value<QObject *>());
}

} // namespace

DaemonTree::DaemonTree(Fleet &fleet, QWidget *parent)
    : QTreeWidget(parent)
    , fleet_(fleet) {
    setColumnCount(2);
    setHeaderLabels({tr("Daemon"), tr("State")});
    header()->setSectionResizeMode(NameColumn, QHeaderView::Stretch);
    // Names have the room: what does not fit into the state has its tool tip.
    header()->setSectionResizeMode(StateColumn, QHeaderView::Fixed);
    header()->resizeSection(StateColumn, fontMetrics().horizontalAdvance("degraded") + iconRoom);
    header()->setStretchLastSection(false);
    setUniformRowHeights(true);
    setIndentation(12);
    setEditTriggers(QAbstractItemView::NoEditTriggers); // but from the menu
    connect(this, &QTreeWidget::currentItemChanged, this, &DaemonTree::choose);
    connect(this, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem *item) {
        if (Robot *const robot = isUpdating_ ? nullptr : robotOf(item))
            fleet_.rename(*robot, item->text(NameColumn));
    });
    connect(&fleet, &Fleet::changed, this, &DaemonTree::update);
    connect(&fleet, &Fleet::robotChosen, this, &DaemonTree::showChoice);
    connect(&fleet, &Fleet::daemonChosen, this, &DaemonTree::showChoice);
    update();
}

/// The row that it has, at its place, or a new one.
QTreeWidgetItem *DaemonTree::rowOf(const void *shown, QTreeWidgetItem *parent, int row) {
    QTreeWidgetItem *item = items_.value(shown);
    if (item && item->parent() != parent) { // of another robot now
        delete item->parent()->takeChild(item->parent()->indexOfChild(item));
        item = nullptr;
    }
    if (!item) {
        item = new QTreeWidgetItem;
        if (parent)
            parent->insertChild(row, item);
        else
            insertTopLevelItem(row, item);
    }
    items_.remove(shown);
    shown_.insert(shown, item);
    return item;
}

void DaemonTree::update() {
    isUpdating_ = true;
    int robotRow = 0;
    for (const auto &robot : fleet_.robots()) {
        const bool isNew = !items_.contains(robot.get());
        QTreeWidgetItem *const item = rowOf(robot.get(), nullptr, robotRow++);
        if (isNew) {
            item->setExpanded(true);
            item->setFirstColumnSpanned(true);
        }
        showRobot(*item, *robot);
        int row = 0;
        for (DaemonLink *daemon : robot->daemons()) {
            QTreeWidgetItem *const child = rowOf(daemon, item, row++);
            child->setData(NameColumn, Qt::UserRole, QVariant::fromValue<QObject *>(daemon));
            showDaemon(*child, *robot, *daemon);
        }
    }
    dropRows();
    isUpdating_ = false;
    showChoice();
}

/// Of what is not there any more; the daemons before their robots, whose rows hold theirs.
void DaemonTree::dropRows() {
    for (const bool isDaemon : {true, false})
        for (auto gone = items_.begin(); gone != items_.end();) {
            if (isDaemon != bool(gone.value()->parent())) {
                ++gone;
                continue;
            }
            delete gone.value();
            gone = items_.erase(gone);
        }
    items_ = std::exchange(shown_, {});
}

void DaemonTree::showRobot(QTreeWidgetItem &item, const Robot &robot) {
    if (state() == QAbstractItemView::EditingState)
        return; // what is typed would be lost
    item.setText(NameColumn, fleet_.titleOf(robot));
    QStringList toolTip{tr("Robot %1 at %2").arg(robot.id(), robot.address()), robot.problem()};
    toolTip.removeAll(QString());
    item.setToolTip(NameColumn, toolTipOf(toolTip.join('\n')));
    const QVariant isWell = robot.problem().isEmpty();
    if (item.data(NameColumn, conditionRole) == isWell)
        return;
    item.setData(NameColumn, conditionRole, isWell);
    item.setIcon(NameColumn, isWell.toBool() ? theme::icon("robot") : theme::icon(Condition::Warning));
}

void DaemonTree::showDaemon(QTreeWidgetItem &item, const Robot &robot, const DaemonLink &daemon) {
    const ProcessStatus *const process = robot.process(daemon);
    const QString processState = process ? shortLine(process->state, longestWord) : QString();
    const bool isStopped = !daemon.isConnected() && !processState.isEmpty() && processState != "running";
    const QString word = isStopped ? processState : daemon.conditionWord();
    QStringList toolTip{daemon.title() + ", " + daemon.address(), word, daemon.reason(), usage(process)};
    toolTip.removeAll(QString());
    setText(item, daemon.name(), word, daemon.condition(), toolTip.join('\n'));
    showHealth(item, daemon);
}

void DaemonTree::showHealth(QTreeWidgetItem &item, const DaemonLink &daemon) {
    const std::vector<HealthItem> &health = daemon.status().health;
    const int count = daemon.isConnected() && !daemon.isSilent() ? int(health.size()) : 0;
    const int shown = qMin(count, maxHealthItems);
    const int rows = shown + (count > shown ? 1 : 0);
    while (item.childCount() > rows)
        delete item.takeChild(item.childCount() - 1);
    while (item.childCount() < rows)
        item.addChild(new QTreeWidgetItem);
    for (int i = 0; i < shown; ++i) {
        const HealthItem &one = health[std::size_t(i)];
        setText(*item.child(i), shortLine(one.name, longestName), shortLine(one.level, longestWord),
                conditionOf(one.level), one.message);
    }
    if (rows > shown)
        setText(*item.child(shown), tr("%1 more").arg(count - shown), {}, Condition::Warning, {});
}

void DaemonTree::lookFor(const QString &address) {
    for (const auto &robot : fleet_.robots())
        for (const DaemonLink *daemon : robot->daemons())
            if (QTreeWidgetItem *const item = items_.value(daemon);
                item && (daemon->address() == address || daemon->host() == address)) {
                setCurrentItem(item);
                return scrollToItem(item);
            }
}

/// Where another panel has chosen.
void DaemonTree::showChoice() {
    const void *const chosen = fleet_.daemon() ? static_cast<const void *>(fleet_.daemon()) : fleet_.robot();
    QTreeWidgetItem *const item = items_.value(chosen);
    QTreeWidgetItem *const current = currentItem();
    if (isUpdating_ || !item || item == current || (current && current->parent() == item && fleet_.daemon()))
        return;
    isUpdating_ = true;
    setCurrentItem(item);
    isUpdating_ = false;
}

void DaemonTree::choose() {
    if (isUpdating_)
        return;
    QTreeWidgetItem *item = currentItem();
    while (item && item->parent() && item->parent()->parent())
        item = item->parent(); // a health item stands for its daemon
    if (!item)
        return;
    Q_EMIT clickedAt();
    if (item->parent())
        fleet_.choose(daemonIn(*item));
    else if (Robot *const robot = robotOf(item))
        fleet_.choose(robot);
}

Robot *DaemonTree::robotOf(const QTreeWidgetItem *item) const {
    for (const auto &robot : fleet_.robots())
        if (item && items_.value(robot.get()) == item)
            return robot.get();
    return nullptr;
}

void DaemonTree::contextMenuEvent(QContextMenuEvent *event) {
    const bool isKey = event->reason() == QContextMenuEvent::Keyboard;
    QTreeWidgetItem *const item = isKey ? currentItem() : itemAt(event->pos());
    if (item)
        showMenu(item, isKey ? visualItemRect(item).center() : event->pos());
}

/// To look into a menu is not to choose.
void DaemonTree::mousePressEvent(QMouseEvent *event) {
    if (event->button() != Qt::RightButton)
        QTreeWidget::mousePressEvent(event);
}

void DaemonTree::mouseReleaseEvent(QMouseEvent *event) {
    QTreeWidget::mouseReleaseEvent(event);
    if (event->button() == Qt::LeftButton && state() != EditingState)
        Q_EMIT takenByMouse();
}

void DaemonTree::showMenu(QTreeWidgetItem *item, const QPoint &place) {
    while (item && item->parent())
        item = item->parent();
    Robot *const robot = robotOf(item);
    if (!robot)
        return;
    auto *const menu = named(new QMenu(this), "rowMenu");
    menu->setAttribute(Qt::WA_DeleteOnClose);
    const QString title = labelText(fleet_.titleOf(*robot));
    const QPointer<Robot> still(robot);
    add(*menu, tr("Re&name %1").arg(title), "renameRobot", [this, menu, still] {
        connect(menu, &QObject::destroyed, this, [this, still] { // the focus is back then
            if (still && items_.contains(still))
                rename(items_[still]);
        });
    });
    add(*menu, tr("&Remove %1 from this window").arg(title), "removeRobot", [this, still] {
        if (still && fleet_.robotAt(still->id()) == still)
            Q_EMIT removalAsked(still);
    });
    menu->popup(viewport()->mapToGlobal(place));
}

void DaemonTree::add(QMenu &menu, const QString &text, const QString &name,
                     const std::function<void()> &work) {
    connect(named(menu.addAction(text), name), &QAction::triggered, this, work);
}

void DaemonTree::rename(QTreeWidgetItem *item) {
    isUpdating_ = true; // what is changed is no new name
    item->setText(NameColumn, robotOf(item)->name());
    item->setFlags(item->flags() | Qt::ItemIsEditable);
    isUpdating_ = false;
    editItem(item, NameColumn);
}

} // namespace hermes::desktop
