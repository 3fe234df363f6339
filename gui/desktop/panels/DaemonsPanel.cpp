#include "gui/desktop/panels/DaemonsPanel.h"

#include "gui/desktop/Theme.h"
#include "gui/desktop/panels/DaemonTree.h"
#include "gui/desktop/widgets/Arrangement.h"
#include "gui/desktop/widgets/MessageLabel.h"

#include <QLineEdit>
#include <QPushButton>
#include <algorithm>

namespace hermes::desktop {
DaemonsPanel::DaemonsPanel(Fleet &fleet, QWidget *parent)
    : QWidget(parent)
    , fleet_(fleet)
    , address_(named(new QLineEdit, "address",
                     tr("Of a robot, as 192.168.1.20, or of one daemon, as 192.168.1.20:7410")))
    , find_(named(new QPushButton(tr("F&ind")), "find",
                  tr("Looks for daemons that announce themselves on the network")))
    , search_(this)
    , tree_(named(new DaemonTree(fleet), "tree"))
    , hint_(new PlainLabel(tr("No daemon found yet. Add one by its address, for example 192.168.1.20 or "
                              "127.0.0.1:7450, or start the simulator with ./demo.")))
    , message_(new MessageLabel)
    , undo_(named(new QPushButton, "undoRemoval", tr("Adds the robot again that was removed last"))) {
    tree_->setAccessibleName(tr("Robots and their daemons"));
    hint_->setWordWrap(true);
    address_->setPlaceholderText(tr("Address"));
    undo_->hide();
    auto *const add = named(new QPushButton(theme::icon("add"), tr("A&dd")), "add");
    setLayout(inColumn(
        {inRow({address_, add, find_}), hint_, {tree_, 1}, inRow({{message_, 1}, undo_}), makeButtons()}));

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

QLayout *DaemonsPanel::makeButtons() {
    const auto button = [this](const QString &icon, const QString &text, const QString &method) {
        auto *const made = named(new QPushButton(theme::icon(icon), text), method);
        connect(made, &QPushButton::clicked, this, [this, method] { ask(method); });
        return made;
    };
    start_ = button("start", tr("St&art"), "process.start");
    stop_ = button("stop", tr("St&op"), "process.stop");
    restart_ = button("restart", tr("R&estart"), "process.restart");
    return inRow({start_, stop_, restart_});
}

DaemonsPanel::Supervised DaemonsPanel::chosen() const {
    const DaemonLink *const daemon = fleet_.daemon();
    const Robot *const robot = fleet_.robot();
    const ProcessStatus *const process = daemon && robot ? robot->process(*daemon) : nullptr;
    return {process, process ? robot->supervisorOf(*daemon) : nullptr};
}

void DaemonsPanel::update() {
    const bool isAnyone = std::any_of(fleet_.robots().begin(), fleet_.robots().end(),
                                      [](const auto &robot) { return !robot->daemons().empty(); });
    hint_->setVisible(!isAnyone);
    updateButtons();
}

void DaemonsPanel::updateButtons() {
    const auto [process, supervisor] = chosen();
    const bool isRunning = process && process->pid > 0;
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
    undo_->setText(tr("Bring %1 back").arg(labelText(name)));
    undo_->show();
}

void DaemonsPanel::bringBack() {
    for (const QString &address : qAsConst(removed_))
        fleet_.add(address);
    undo_->hide();
    message_->hide();
}

void DaemonsPanel::ask(const QString &method) {
    const auto [process, supervisor] = chosen();
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
