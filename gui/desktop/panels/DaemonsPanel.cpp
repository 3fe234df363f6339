#include "gui/desktop/panels/DaemonsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/DaemonTree.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QHBoxLayout>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>
#include <algorithm>

namespace hermes::desktop {
DaemonsPanel::DaemonsPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , address_(new QLineEdit)
    , find_(new QPushButton(tr("F&ind")))
    , search_(this)
    , tree_(new DaemonTree(fleet))
    , hint_(new PlainLabel(tr("No daemon found yet. Add one by its address, for example 192.168.1.20 or "
                              "127.0.0.1:7450, or start the simulator with ./demo.")))
    , message_(new MessageLabel)
    , undo_(new QPushButton) {
    tree_->setObjectName("tree");
    tree_->setAccessibleName(tr("Robots and their daemons"));
    hint_->setWordWrap(true);

    address_->setObjectName("address");
    address_->setPlaceholderText(tr("Address"));
    address_->setToolTip(tr("Of a robot, as 192.168.1.20, or of one daemon, as 192.168.1.20:7410"));
    auto *const add = new QPushButton(theme::icon("add"), tr("A&dd"));
    add->setObjectName("add");
    auto *const adding = new QHBoxLayout;
    adding->addWidget(address_);
    adding->addWidget(add);
    adding->addWidget(find_);

    undo_->setObjectName("undoRemoval");
    undo_->setToolTip(tr("Adds the robot again that was removed last"));
    undo_->hide();
    find_->setObjectName("find");
    find_->setToolTip(tr("Looks for daemons that announce themselves on the network"));

    auto *const layout = new QVBoxLayout(this);
    layout->addLayout(adding);
    layout->addWidget(hint_);
    layout->addWidget(tree_, 1);
    auto *const told = new QHBoxLayout;
    told->addWidget(message_, 1);
    told->addWidget(undo_);
    layout->addLayout(told);
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
    connect(tree_, &DaemonTree::clickedAt, message_, &QWidget::hide);
    connect(tree_, &DaemonTree::removalAsked, this, &DaemonsPanel::remove);
    connect(undo_, &QPushButton::clicked, this, &DaemonsPanel::bringBack);
    connect(&fleet, &Fleet::changed, this, &DaemonsPanel::update);
    connect(&fleet, &Fleet::robotChosen, this, &DaemonsPanel::updateButtons);
    connect(&fleet, &Fleet::daemonChosen, this, &DaemonsPanel::updateButtons);
    update();
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

void DaemonsPanel::update() {
    const bool isAnyone = std::any_of(fleet_.robots().begin(), fleet_.robots().end(),
                                      [](const auto &robot) { return !robot->daemons().empty(); });
    hint_->setVisible(!isAnyone);
    updateButtons();
}

void DaemonsPanel::updateButtons() {
    const DaemonLink *const daemon = fleet_.daemon();
    const Robot *const robot = fleet_.robot();
    const ProcessStatus *const process = daemon && robot ? robot->process(*daemon) : nullptr;
    const bool isRunning = process && process->pid > 0;
    const DaemonLink *const supervisor = process ? robot->supervisorOf(*daemon) : nullptr;
    const QString why = supervisor ? supervisor->refusal("process.start")
                                   : tr("Only for daemons that the robot's supervisor runs");
    start_->setEnabled(why.isEmpty() && !isRunning);
    stop_->setEnabled(why.isEmpty() && isRunning);
    restart_->setEnabled(why.isEmpty() && isRunning);
    for (QPushButton *button : {start_, stop_, restart_})
        button->setToolTip(why);
}

void DaemonsPanel::addAddress() {
    const QString address = address_->text().trimmed();
    const auto added = fleet_.add(address);
    if (!added)
        return message_->tell(added.error().message, true);
    tree_->lookFor(address);
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

void DaemonsPanel::remove(Robot *robot) {
    const QString name = fleet_.titleOf(*robot);
    const auto removed = fleet_.remove(robot);
    if (!removed)
        return message_->tell(removed.error().message, true);
    removed_ = *removed;
    message_->tell(tr("%1 was removed from this window.").arg(name));
    undo_->setText(tr("Bring %1 back").arg(QString(name).replace('&', "&&")));
    undo_->show();
}

void DaemonsPanel::bringBack() {
    for (const QString &address : qAsConst(removed_))
        fleet_.add(address);
    undo_->hide();
    message_->hide();
}

void DaemonsPanel::ask(const QString &method) {
    const Robot *const robot = fleet_.robot();
    const DaemonLink *const daemon = fleet_.daemon();
    const ProcessStatus *const process = robot && daemon ? robot->process(*daemon) : nullptr;
    DaemonLink *const supervisor = process ? robot->supervisorOf(*daemon) : nullptr;
    if (!supervisor)
        return;
    supervisor->call(method, {{"name", process->entry.name}}, this, [this](const Result<QJsonValue> &done) {
        if (done)
            message_->hide();
        else
            message_->tell(done.error().message, true);
    });
}

} // namespace hermes::desktop
