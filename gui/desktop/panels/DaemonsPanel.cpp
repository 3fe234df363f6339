#include "gui/desktop/panels/DaemonsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QHBoxLayout>
#include <QHeaderView>
#include <QJsonArray>
#include <QLineEdit>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <QtMath>

namespace hermes::desktop {
namespace {

enum Column { NameColumn, StateColumn };

constexpr int longestName = 60, longestWord = 20, mostHealthItems = 50;

Condition conditionOf(const QString &level) {
    return level == "ok" ? Condition::Ready : level == "error" ? Condition::Fault : Condition::Warning;
}

void setText(QTreeWidgetItem &item, const QString &name, const QString &state, Condition condition,
             const QString &toolTip) {
    item.setText(NameColumn, name);
    item.setText(StateColumn, state);
    item.setIcon(StateColumn, theme::icon(condition));
    item.setForeground(StateColumn, theme::colour(condition));
    for (const Column column : {NameColumn, StateColumn})
        item.setToolTip(column, toolTipOf(toolTip));
}

/// What the supervisor says of a process: share of a core, memory, restarts.
QString usage(const ProcessStatus *process) {
    if (!process || process->pid == 0)
        return {};
    return DaemonsPanel::tr("%1 % of a core, %2 MB, %3 restarts")
        .arg(shortNumber(100 * process->cpu.value_or(0), 1),
             shortNumber(double(process->memory_bytes.value_or(0)) / 1e6, 1))
        .arg(process->restarts);
}

} // namespace

DaemonsPanel::DaemonsPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , address_(new QLineEdit)
    , find_(new QPushButton(tr("F&ind")))
    , search_(this)
    , tree_(new QTreeWidget)
    , hint_(new PlainLabel(tr("No daemon found yet. Add one by its address, for example 192.168.1.20 or "
                              "127.0.0.1:7450, or start the simulator with ./demo.")))
    , message_(new MessageLabel) {
    tree_->setObjectName("tree");
    tree_->setAccessibleName(tr("Robots and their daemons"));
    tree_->setColumnCount(2);
    tree_->setHeaderLabels({tr("Daemon"), tr("State")});
    tree_->header()->setSectionResizeMode(NameColumn, QHeaderView::Stretch);
    tree_->header()->setSectionResizeMode(StateColumn, QHeaderView::ResizeToContents);
    tree_->header()->setStretchLastSection(false);
    tree_->setUniformRowHeights(true);
    hint_->setWordWrap(true);

    address_->setObjectName("address");
    address_->setPlaceholderText(tr("HOST or HOST:PORT"));
    auto *const add = new QPushButton(theme::icon("add"), tr("A&dd"));
    add->setObjectName("add");
    auto *const adding = new QHBoxLayout;
    adding->addWidget(address_);
    adding->addWidget(add);
    adding->addWidget(find_);

    find_->setObjectName("find");
    find_->setToolTip(tr("Looks for daemons that announce themselves on the network (Avahi)"));

    auto *const layout = new QVBoxLayout(this);
    layout->addLayout(adding);
    layout->addWidget(hint_);
    layout->addWidget(tree_, 1);
    layout->addWidget(message_);
    layout->addWidget(makeButtons());

    connect(add, &QPushButton::clicked, this, &DaemonsPanel::addAddress);
    connect(find_, &QPushButton::clicked, this, [this] {
        find_->setEnabled(false);
        message_->tell(tr("Looking for daemons on the network..."), false);
        search_.start();
    });
    connect(&search_, &NetworkSearch::found, this, &DaemonsPanel::addFound);
    connect(&search_, &NetworkSearch::failed, this, [this](const QString &why) {
        find_->setEnabled(true);
        message_->tell(why, true);
    });
    connect(address_, &QLineEdit::returnPressed, this, &DaemonsPanel::addAddress);
    connect(tree_, &QTreeWidget::currentItemChanged, this, &DaemonsPanel::showChosen);
    connect(&fleet, &Fleet::changed, this, &DaemonsPanel::updateTree);
    connect(&fleet, &Fleet::daemonChosen, this, &DaemonsPanel::updateButtons);
    updateTree();
}

QWidget *DaemonsPanel::makeButtons() {
    auto *const row = new QWidget;
    auto *const layout = new QHBoxLayout(row);
    layout->setContentsMargins(0, 0, 0, 0);
    const auto button = [&](const QString &icon, const QString &text, const QString &method) {
        auto *const made = new QPushButton(theme::icon(icon), text);
        made->setObjectName(method);
        connect(made, &QPushButton::clicked, this, [this, method] { ask(method); });
        layout->addWidget(made);
        return made;
    };
    start_ = button("start", tr("St&art"), "process.start");
    stop_ = button("stop", tr("St&op"), "process.stop");
    restart_ = button("restart", tr("R&estart"), "process.restart");
    return row;
}

void DaemonsPanel::updateTree() {
    isUpdating_ = true;
    QHash<const void *, QTreeWidgetItem *> present;
    int robotRow = 0;
    for (const auto &robot : fleet_.robots()) {
        QTreeWidgetItem *item = items_.take(robot.get());
        if (!item) {
            item = new QTreeWidgetItem;
            tree_->insertTopLevelItem(robotRow, item);
            item->setExpanded(true);
            item->setFirstColumnSpanned(true);
        }
        ++robotRow;
        item->setText(NameColumn, robot->name());
        item->setToolTip(NameColumn, toolTipOf(robot->problem()));
        item->setIcon(NameColumn,
                      robot->problem().isEmpty() ? theme::icon("robot") : theme::icon(Condition::Warning));
        present.insert(robot.get(), item);
        int row = 0;
        for (DaemonLink *daemon : robot->daemons()) {
            QTreeWidgetItem *child = items_.take(daemon);
            if (!child) {
                child = new QTreeWidgetItem;
                child->setData(NameColumn, Qt::UserRole, QVariant::fromValue<QObject *>(daemon));
                item->insertChild(row, child);
            }
            ++row;
            showDaemon(*child, *robot, *daemon);
            present.insert(daemon, child);
        }
    }
    for (auto gone = items_.begin(); gone != items_.end(); ++gone)
        if (gone.value()->parent())
            delete gone.value();
    items_ = present;
    hint_->setVisible(present.size() <= int(fleet_.robots().size()));
    isUpdating_ = false;
    updateButtons();
}

void DaemonsPanel::showDaemon(QTreeWidgetItem &item, const Robot &robot, const DaemonLink &daemon) {
    const ProcessStatus *const process = robot.process(daemon);
    const QString processState = process ? shortLine(process->state, longestWord) : QString();
    const bool isStopped = !daemon.isConnected() && !processState.isEmpty() && processState != "running";
    QStringList toolTip{daemon.title() + ", " + daemon.address(), daemon.reason(), usage(process)};
    toolTip.removeAll(QString());
    setText(item, daemon.name(), isStopped ? processState : daemon.conditionWord(), daemon.condition(),
            toolTip.join('\n'));

    const std::vector<HealthItem> &health = daemon.status().health;
    const int count = daemon.isConnected() && !daemon.isSilent() ? int(health.size()) : 0;
    const int shown = qMin(count, mostHealthItems);
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

void DaemonsPanel::showChosen() {
    if (isUpdating_)
        return;
    QTreeWidgetItem *item = tree_->currentItem();
    while (item && item->parent() && item->parent()->parent())
        item = item->parent(); // a health item stands for its daemon
    if (!item)
        return;
    message_->hide();
    if (item->parent())
        return fleet_.choose(
            qobject_cast<DaemonLink *>(item->data(NameColumn, Qt::UserRole).value<QObject *>()));
    const int row = tree_->indexOfTopLevelItem(item);
    fleet_.choose(fleet_.robots().at(size_t(row)).get());
}

void DaemonsPanel::updateButtons() {
    const DaemonLink *const daemon = fleet_.daemon();
    const Robot *const robot = fleet_.robot();
    const ProcessStatus *const process = daemon && robot ? robot->process(*daemon) : nullptr;
    const bool isRunning = process && process->pid > 0;
    const bool isManaged = process && robot->supervisor();
    const QString why = isManaged ? robot->supervisor()->refusal("process.start")
                                  : tr("Only for daemons that the robot's supervisor runs");
    start_->setEnabled(why.isEmpty() && !isRunning);
    stop_->setEnabled(why.isEmpty() && isRunning);
    restart_->setEnabled(why.isEmpty() && isRunning);
    for (QPushButton *button : {start_, stop_, restart_})
        button->setToolTip(why);
}

void DaemonsPanel::addAddress() {
    const auto added = fleet_.add(address_->text().trimmed());
    if (!added)
        return message_->tell(added.error().message, true);
    address_->clear();
    message_->hide();
}

void DaemonsPanel::addFound(const QStringList &urls) {
    find_->setEnabled(true);
    int added = 0;
    for (const QString &url : urls)
        added += fleet_.add(url).ok();
    message_->tell(
        tr("%1 daemons announce themselves on the network, %2 were added").arg(urls.size()).arg(added),
        false);
}

void DaemonsPanel::ask(const QString &method) {
    DaemonLink *const supervisor = fleet_.robot() ? fleet_.robot()->supervisor() : nullptr;
    if (!supervisor || !fleet_.daemon())
        return;
    const ProcessStatus *const process = fleet_.robot()->process(*fleet_.daemon());
    if (!process)
        return;
    supervisor->call(method, {{"name", process->entry.name}}, this, [this](const Result<QJsonValue> &done) {
        if (done)
            message_->hide();
        else
            message_->tell(done.error().message, true);
    });
}

} // namespace hermes::desktop
