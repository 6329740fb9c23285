#include "src/ui/stereo_panel.h"

#include <QCloseEvent>
#include <QCoreApplication>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QTableWidget>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include "mvs/patch_match.h"
#include "src/colmap/progress_news.h"

namespace tapa {
namespace {

// Of the table.
constexpr int kNameColumn = 0;
constexpr int kPhotometricColumn = 2;
constexpr int kGeometricColumn = 3;

constexpr char kPanelName[] = "tapa_stereo_panel";

class StereoPanel : public QWidget {
 public:
  StereoPanel(QWidget* window, QTableWidget* table,
              std::unique_ptr<colmap::mvs::PatchMatchController> stereo,
              MapButtons map_buttons)
      : QWidget(window),
        window_(window),
        table_(table),
        stereo_(std::move(stereo)),
        map_buttons_(std::move(map_buttons)) {
    setObjectName(kPanelName);
    AddWidgets();
    window->installEventFilter(this);
    // Before anything that the run's thread might still call is destroyed.
    connect(qApp, &QCoreApplication::aboutToQuit, this, [this] { End(); });
    BlockOthers();
    Start();
  }

  ~StereoPanel() override { End(); }

 protected:
  // As long as the run goes on, the window stays open, and what COLMAP enables
  // when it is shown again stays blocked.
  bool eventFilter(QObject* object, QEvent* event) override {
    if (!stop_button_->isHidden()) {
      if (object == window_ && event->type() == QEvent::Close) {
        event->ignore();
        return true;
      }
      if (object != window_ && event->type() == QEvent::EnabledChange) {
        Block(static_cast<QWidget*>(object));
      }
    }
    return QWidget::eventFilter(object, event);
  }

 private:
  void AddWidgets() {
    bar_ = new QProgressBar(this);
    bar_->setRange(0, 1000);
    bar_->setTextVisible(false);
    text_ = new QLabel("Preparing ...", this);
    // A long name must not widen the window.
    text_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
    stop_button_ = new QPushButton("Stop", this);
    connect(stop_button_, &QPushButton::clicked, this, [this] {
      stop_button_->setEnabled(false);
      text_->setText("Stopping ...");
      stereo_->Stop();
    });
    auto* layout = new QGridLayout(this);
    layout->setContentsMargins(0, 0, 0, 0);
    layout->addWidget(bar_, 0, 0);
    layout->addWidget(text_, 0, 1);
    layout->addWidget(stop_button_, 0, 2);
    layout->setColumnStretch(1, 1);

    constexpr int kRowBelowTable = 2;
    auto* grid = static_cast<QGridLayout*>(window_->layout());
    grid->addWidget(this, kRowBelowTable, 0, 1, grid->columnCount());
  }

  void Start() {
    // The run's thread must not touch widgets.
    stereo_->SetListener([this](const ProgressNews& news) {
      QMetaObject::invokeMethod(
          this, [this, news] { Show(news); }, Qt::QueuedConnection);
    });
    stereo_->AddCallback(colmap::Thread::FINISHED_CALLBACK, [this] {
      QMetaObject::invokeMethod(
          this, [this] { ShowEnd(); }, Qt::QueuedConnection);
    });
    stereo_->Start();
  }

  void End() {
    stereo_->Stop();
    stereo_->Wait();
  }

  // Disables all that would disturb the run.
  void BlockOthers() {
    for (QWidget* widget : window_->findChildren<QWidget*>(
             QString(), Qt::FindDirectChildrenOnly)) {
      if (qobject_cast<QPushButton*>(widget) ||
          qobject_cast<QLineEdit*>(widget)) {
        widget->installEventFilter(this);
        Block(widget);
      }
    }
  }

  void Block(QWidget* widget) {
    if (widget->isEnabled()) {
      widget->setEnabled(false);
      blocked_.insert(widget);
    }
  }

  void Show(const ProgressNews& news) {
    bar_->setValue(static_cast<int>(std::lround(1000 * news.share)));
    if (stop_button_->isEnabled()) {
      text_->setText(QString::fromStdString(news.text).trimmed());
    }
    if (!news.finished_view.empty()) {
      AddMaps(news);
    }
  }

  void AddMaps(const ProgressNews& news) {
    const QString name = QString::fromStdString(news.finished_view);
    const int column = news.finished_pass == Pass::kGeometric
                           ? kGeometricColumn
                           : kPhotometricColumn;
    for (int row = 0; row < table_->rowCount(); ++row) {
      if (table_->item(row, kNameColumn)->text() == name) {
        table_->setCellWidget(
            row, column,
            map_buttons_(news.finished_view, PassName(news.finished_pass)));
      }
    }
    table_->resizeColumnToContents(column);
  }

  void ShowEnd() {
    stereo_->Wait();
    const int status = stereo_->ExitStatus();
    const bool was_stopped =
        !stop_button_->isEnabled() || status > EXIT_FAILURE;
    text_->setText(status == EXIT_SUCCESS ? "Stereo is complete."
                   : was_stopped ? "Stopped; Stereo goes on from there."
                                 : "Stereo failed; the log tells why.");
    bar_->hide();
    stop_button_->hide();
    for (QWidget* widget : blocked_) {
      widget->setEnabled(true);
    }
  }

  QWidget* const window_;
  QTableWidget* const table_;
  const std::unique_ptr<colmap::mvs::PatchMatchController> stereo_;
  const MapButtons map_buttons_;
  QProgressBar* bar_;
  QLabel* text_;
  QPushButton* stop_button_;
  std::set<QWidget*> blocked_;
};

}  // namespace

void StartStereo(QWidget* window, QTableWidget* table,
                 std::unique_ptr<colmap::mvs::PatchMatchController> stereo,
                 MapButtons map_buttons) {
  // Of the last run.
  delete window->findChild<QWidget*>(kPanelName);
  new StereoPanel(window, table, std::move(stereo), std::move(map_buttons));
}

}  // namespace tapa
