#include "vo/sequence/reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

namespace {

namespace fs = std::filesystem;

class Reader : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("reader_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "rgb");
    cv::imwrite((folder_ / "rgb/a.png").string(), cv::Mat(4, 6, CV_8UC3, cv::Scalar(10, 20, 30)));
    cv::imwrite((folder_ / "rgb/b.png").string(), cv::Mat(4, 6, CV_8UC1, cv::Scalar(77)));
  }
  void TearDown() override { fs::remove_all(folder_); }
  void List(const std::string& text) const { std::ofstream(folder_ / "rgb.txt") << text; }
  std::string ErrorOfOpening() const {
    try {
      vo::SequenceReader reader(folder_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(Reader, ReadsColourAndGreyWithExactStamps) {
  List("# comment\n1305031102.175304 rgb/a.png\n1305031102.2 rgb/b.png\n");
  vo::SequenceReader reader(folder_);
  ASSERT_EQ(reader.size(), 2u);
  const auto a = reader.Next(), b = reader.Next();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->stamp_ns, 1305031102175304000);
  EXPECT_EQ(b->stamp_ns, 1305031102200000000);
  EXPECT_EQ(a->image.type(), CV_8UC3);
  EXPECT_EQ(a->image.at<cv::Vec3b>(1, 1), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(b->image.type(), CV_8UC1);
  EXPECT_FALSE(reader.Next());
}

TEST_F(Reader, ReadsNamesWithBlanks) {
  fs::copy(folder_ / "rgb/b.png", folder_ / "rgb/my frame, 1.png");
  List("1.0 rgb/my frame, 1.png\r\n2.0,\"rgb\\my frame, 1.png\"\n3.0 rgb/my frame.png\n");
  EXPECT_EQ(ErrorOfOpening(), (folder_ / "rgb.txt").string() + ":3: expected 'timestamp filename'");
  List("1.0 rgb/my frame, 1.png\r\n2.0,\"rgb\\my frame, 1.png\"\n");
  EXPECT_EQ(vo::SequenceReader(folder_).size(), 2u);
}

TEST_F(Reader, ReadsTheOriginalIclNuimLayout) {
  std::ofstream(folder_ / "associations.txt") << "1 depth/1.png 1 rgb/a.png\n2 depth/2.png 2 rgb/b.png\n";
  vo::SequenceReader reader(folder_);
  ASSERT_EQ(reader.size(), 2u);
  EXPECT_EQ(reader.Next()->stamp_ns, 33333333);
  EXPECT_EQ(reader.Next()->stamp_ns, 66666667);
}

TEST_F(Reader, ReadsTheLayoutOfKitti) {
  fs::create_directories(folder_ / "image_2");
  fs::rename(folder_ / "rgb/a.png", folder_ / "image_2/000000.png");
  fs::rename(folder_ / "rgb/b.png", folder_ / "image_2/000001.png");
  std::ofstream(folder_ / "times.txt") << "0.000000e+00\n1.037359e-01\n";
  vo::SequenceReader reader(folder_);
  EXPECT_EQ(reader.Next()->image.type(), CV_8UC3);
  EXPECT_EQ(reader.Next()->stamp_ns, 103735900);
  std::ofstream(folder_ / "times.txt", std::ios::app) << "0.2 x\n0.3\n";
  EXPECT_NE(ErrorOfOpening().find("times.txt:3: expected 'time'"), std::string::npos) << ErrorOfOpening();
  EXPECT_NE(ErrorOfOpening().find("image_2/000002.png is not there"), std::string::npos) << ErrorOfOpening();
}

TEST_F(Reader, ReadsTheLayoutOfTumsMonocularDataSet) {
  fs::create_directories(folder_ / "images");
  fs::rename(folder_ / "rgb/a.png", folder_ / "images/00000.png");
  fs::rename(folder_ / "rgb/b.png", folder_ / "images/00002.jpg");
  std::ofstream(folder_ / "times.txt") << "00000 1435148236.344000 1.67\n00002 1435148236.424000\n";
  vo::SequenceReader reader(folder_);
  EXPECT_EQ(reader.Next()->stamp_ns, 1435148236344000000);
  EXPECT_EQ(reader.Next()->stamp_ns, 1435148236424000000) << "of an unknown exposure";
  std::ofstream(folder_ / "times.txt", std::ios::app) << "00003\n00004 x\n00005 1435148237 1\n";
  const std::string error = ErrorOfOpening();
  EXPECT_NE(error.find("times.txt:3: expected 'number time exposure'"), std::string::npos) << error;
  EXPECT_NE(error.find("times.txt:4: 'x' is not a time in seconds"), std::string::npos) << error;
  EXPECT_NE(error.find("images/00005.jpg is not there"), std::string::npos) << error;
}

TEST_F(Reader, RefusesStampsInOtherUnits) {
  List("0 rgb/a.png\n33 rgb/b.png\n");
  EXPECT_NE(ErrorOfOpening().find("10 s and more apart: stamps are seconds"), std::string::npos) << ErrorOfOpening();
  List("0 rgb/a.png\n33 rgb/b.png\n34 rgb/b.png\n");
  EXPECT_EQ(ErrorOfOpening(), "") << "a gap";
}

TEST_F(Reader, ReadsTheLayoutOfEuroc) {
  fs::create_directories(folder_ / "mav0/cam0/data");
  fs::rename(folder_ / "rgb/a.png", folder_ / "mav0/cam0/data/1403636579763555584.png");
  fs::rename(folder_ / "rgb/b.png", folder_ / "mav0/cam0/data/1403636579813555456.png");
  const fs::path list = folder_ / "mav0/cam0/data.csv";
  std::ofstream(list) << "#timestamp [ns],filename\r\n1403636579763555584,1403636579763555584.png\r\n"
                         "1403636579813555456,1403636579813555456.png\r\n";
  vo::SequenceReader reader(folder_);
  ASSERT_EQ(reader.size(), 2u);
  EXPECT_EQ(reader.Next()->stamp_ns, 1403636579763555584);
  const auto second = reader.Next();
  EXPECT_EQ(second->stamp_ns, 1403636579813555456);
  EXPECT_EQ(second->image.type(), CV_8UC1);
  std::ofstream(list) << "1403636579763555,1403636579763555584.png\n1403636579813555,1403636579813555456.png\n";
  EXPECT_NE(ErrorOfOpening().find("less than a millisecond apart"), std::string::npos) << "microseconds";
  std::ofstream(list) << "1.5,a.png\n9223372036854775808,a.png\n7\n";
  const std::string error = ErrorOfOpening();
  EXPECT_NE(error.find(list.string() + ":1: '1.5' is not a time stamp in nanoseconds"), std::string::npos) << error;
  EXPECT_NE(error.find(list.string() + ":2: '9223372036854775808' is not"), std::string::npos) << error;
  EXPECT_NE(error.find(list.string() + ":3: expected 'timestamp,filename'"), std::string::npos) << error;
}

TEST_F(Reader, NamesEveryProblemWithItsLine) {
  List("1.0 rgb/a.png\nnan rgb/b.png\n0.5 rgb/b.png\n2.0 rgb/none.png\n3.0\n");
  const std::string error = ErrorOfOpening();
  const std::string list = (folder_ / "rgb.txt").string();
  EXPECT_NE(error.find(list + ":2: 'nan'"), std::string::npos) << error;
  EXPECT_NE(error.find(list + ":3: time stamp 0.5 does not increase over line 1"), std::string::npos) << error;
  EXPECT_NE(error.find(list + ":4: image"), std::string::npos) << error;
  EXPECT_NE(error.find(list + ":5: expected"), std::string::npos) << error;
}

TEST_F(Reader, RefusesFoldersWithoutFrames) {
  EXPECT_NE(ErrorOfOpening().find("rgb.txt: cannot be read"), std::string::npos);
  List("# nothing\n");
  EXPECT_NE(ErrorOfOpening().find("no frames"), std::string::npos);
  fs::remove_all(folder_);
  EXPECT_NE(ErrorOfOpening().find("no such folder"), std::string::npos);
}

// Lists as printed by associate.py of TUM RGB-D, in either order: the depth is the grey picture of 16 bits.
TEST_F(Reader, TakesThePictureThatIsNoDepth) {
  fs::create_directories(folder_ / "depth");
  cv::imwrite((folder_ / "depth/a.png").string(), cv::Mat(4, 6, CV_16UC1, cv::Scalar(5000)));
  for (const char* line : {"3 rgb/a.png 3 depth/a.png\n", "3 depth/a.png 3 rgb/a.png\n"}) {
    std::ofstream(folder_ / "associations.txt") << line;
    vo::SequenceReader reader(folder_);
    const auto frame = reader.Next();
    EXPECT_EQ(frame->stamp_ns, 100000000);
    EXPECT_EQ(frame->image.at<cv::Vec3b>(1, 1), cv::Vec3b(10, 20, 30));
  }
  std::ofstream(folder_ / "associations.txt") << "3 depth/a.png 3 depth/a.png\n";
  EXPECT_NE(ErrorOfOpening().find("associations.txt:1: both pictures are depth"), std::string::npos);
}

// Stamps in seconds, taken from the colour picture; depth that is no PNG of 16 bits is recognised by its name.
TEST_F(Reader, ReadsAssociationsInSeconds) {
  fs::create_directories(folder_ / "depth");
  cv::imwrite((folder_ / "depth/a.png").string(), cv::Mat(4, 6, CV_8UC1, cv::Scalar(50)));
  for (const char* line :
       {"3.5,\"rgb/a.png\",3.25,\"depth/a.png\"\n", "% depth rgb\n3.25 depth/a.png 3.5 rgb/a.png\n"}) {
    std::ofstream(folder_ / "associate.txt") << line;
    vo::SequenceReader reader(folder_);
    const auto frame = reader.Next();
    EXPECT_EQ(frame->stamp_ns, 3'500'000'000);
    EXPECT_EQ(frame->image.at<cv::Vec3b>(1, 1), cv::Vec3b(10, 20, 30));
  }
  std::ofstream(folder_ / "associate.txt") << std::string(
      "\xff\xfe"
      "3\0",
      4);
  EXPECT_NE(ErrorOfOpening().find("associate.txt: is a text in UTF-16"), std::string::npos);
}

// Colour types: alpha is dropped, 16 bits become 8, and bytes after a picture's end are ignored.
TEST_F(Reader, ReadsEveryColourTypeAndPaddedFiles) {
  cv::imwrite((folder_ / "rgb/rgba.png").string(), cv::Mat(4, 6, CV_8UC4, cv::Scalar(10, 20, 30, 255)));
  cv::imwrite((folder_ / "rgb/deep.png").string(), cv::Mat(4, 6, CV_16UC4, cv::Scalar(2570, 5140, 7710, 65535)));
  for (const char* name : {"rgb/a.jpg", "rgb/padded.png"}) {
    cv::imwrite((folder_ / name).string(), cv::Mat(4, 6, CV_8UC3, cv::Scalar(10, 20, 30)));
    std::ofstream(folder_ / name, std::ios::app | std::ios::binary) << std::string(3, '\0');
  }
  List("\xef\xbb\xbf# list\n1,rgb\\rgba.png\n2 rgb/deep.png\n3 rgb/a.jpg\n4 rgb/padded.png\n");
  vo::SequenceReader reader(folder_);
  for (int i = 0; i < 4; ++i) {
    const auto frame = reader.Next();
    ASSERT_EQ(frame->image.type(), CV_8UC3) << i;
    const cv::Vec3b pixel = frame->image.at<cv::Vec3b>(1, 1);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], 10 * (c + 1), i == 2 ? 3 : 0) << i;
  }
}

TEST_F(Reader, NamesTheImageOfAnotherSize) {
  cv::imwrite((folder_ / "rgb/b.png").string(), cv::Mat(5, 6, CV_8UC1));
  List("1 rgb/a.png\n2 rgb/b.png\n");
  vo::SequenceReader reader(folder_);
  reader.Next();
  try {
    reader.Next();
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("rgb/b.png: is 6 x 5 pixels, but the first image is 6 x 4"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Reader, ListsFiftyProblemsAtMost) {
  std::string list;
  for (int i = 1; i <= 70; ++i) list += std::to_string(i) + " rgb/none.png\n";
  List(list);
  const std::string error = ErrorOfOpening();
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 50);
  EXPECT_NE(error.find("... and 20 more problems"), std::string::npos);
}

TEST_F(Reader, StampsInNanosecondsAreAskedBackInOneSentence) {
  List("1403636579763555584 rgb/a.png\n1403636579813555584 rgb/b.png\n");
  const std::string error = ErrorOfOpening();
  EXPECT_NE(error.find("nanoseconds: divide the times by 1e9"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST_F(Reader, NamesATruncatedImage) {
  const fs::path file = folder_ / "rgb/a.png";
  cv::Mat noise(60, 60, CV_8UC1);
  cv::randu(noise, 0, 255);
  cv::imwrite(file.string(), noise);
  fs::resize_file(file, fs::file_size(file) / 2);
  List("1.0 rgb/a.png\n");
  vo::SequenceReader reader(folder_);
  try {
    reader.Next();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos);
  }
}

}  // namespace
