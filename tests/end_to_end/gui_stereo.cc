// Presses the Stereo button of COLMAP's graphical interface.
//
//   gui_stereo WORKSPACE
//
// Exits with 0 when the button's run has ended.

#include <QApplication>
#include <QLabel>
#include <QLineEdit>
#include <QProgressDialog>
#include <QPushButton>
#include <QTimer>
#include <iostream>
#include <set>

#include "mvs/patch_match.h"
#include "ui/dense_reconstruction_widget.h"
#include "ui/main_window.h"
#include "util/option_manager.h"

namespace {

QPushButton* FindButton(QWidget* widget, const QString& text) {
  for (QPushButton* button : widget->findChildren<QPushButton*>()) {
    if (button->text() == text) {
      return button;
    }
  }
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: gui_stereo WORKSPACE" << std::endl;
    return 2;
  }
  colmap::InitializeGlog(argv);
  QApplication application(argc, argv);
  colmap::OptionManager options;
  options.AddAllOptions();
  options.patch_match_stereo->num_iterations = 1;
  options.patch_match_stereo->window_radius = 3;
  colmap::MainWindow main_window(options);
  colmap::DenseReconstructionWidget dense_widget(&main_window, &options);
  dense_widget.show();

  // Our options have their rows.
  std::set<std::string> labels;
  for (const QLabel* label : dense_widget.findChildren<QLabel*>()) {
    labels.insert(label->text().toStdString());
  }
  for (const char* name : {"use_gpu", "num_threads", "seed", "gpu_index"}) {
    if (labels.count(name) == 0) {
      std::cerr << "There is no row for the option " << name << std::endl;
      return 1;
    }
  }

  // Naming the workspace enables the button, later, by an event.
  QPushButton* stereo_button = FindButton(&dense_widget, "Stereo");
  for (QLineEdit* edit : dense_widget.findChildren<QLineEdit*>()) {
    if (edit->parentWidget() == &dense_widget) {
      edit->setText(argv[1]);
    }
  }
  application.processEvents();
  if (stereo_button == nullptr || !stereo_button->isEnabled()) {
    std::cerr << "The Stereo button is not enabled" << std::endl;
    return 1;
  }
  stereo_button->click();

  // The dialog with the progress hides when the run has ended.
  QTimer timer;
  QObject::connect(&timer, &QTimer::timeout, [&]() {
    const auto dialogs = dense_widget.findChildren<QProgressDialog*>();
    if (!dialogs.empty() && !dialogs.first()->isVisible()) {
      application.quit();
    }
  });
  timer.start(50);
  return application.exec();
}
