// Pictures, ranks and verdicts of a result folder, read back.
#include "tools/bench/result/pictures.h"

#include <gmock/gmock.h>

#include "tests/unit/judge/evaluation/temporary_folder.h"
#include "tools/bench/report/summary.h"
#include "tools/bench/result/verdict.h"
#include "tools/judge/evaluation/text_file.h"

namespace vobench::report {
namespace {

using evaluation::InputError;
using evaluation::TemporaryFolder;
using testing::HasSubstr;

KeptPictures Sample() {
  KeptPictures kept{640, 480, {}};
  KeptPicture& picture = kept.pictures.emplace_back();
  picture.stamp_ns = 1'234'567'890;
  Eigen::Matrix2d S;
  S << 4.25, -1.5, -1.5, 9;
  picture.features = {{FeatureMark::Status::matched, {10.25, 20.5}, {11.75, 19}, S},
                      {FeatureMark::Status::fresh, {100, 200}, {100, 200}, Eigen::Matrix2d::Zero()}};
  return kept;
}

TEST(Pictures, ReadBackTheSame) {
  const TemporaryFolder folder;
  KeptPictures kept = Sample();
  kept.pictures[0].features.push_back({FeatureMark::Status::missed, {NAN, 2}, {3, 4}, Eigen::Matrix2d::Zero()});
  WritePictures(folder.path(), kept);
  const KeptPictures back = ReadPictures(folder.path());
  EXPECT_EQ(back.width, 640);
  EXPECT_EQ(back.height, 480);
  ASSERT_EQ(back.pictures.size(), 1u);
  EXPECT_EQ(back.pictures[0].stamp_ns, 1'234'567'890);
  ASSERT_EQ(back.pictures[0].features.size(), 2u) << "what is no number is left out";
  for (std::size_t i = 0; i < 2; ++i) {
    const FeatureMark &a = back.pictures[0].features[i], &b = kept.pictures[0].features[i];
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.predicted, b.predicted);
    EXPECT_EQ(a.pixel, b.pixel);
    EXPECT_EQ(a.covariance, b.covariance);
  }
  const TemporaryFolder empty;
  EXPECT_TRUE(ReadPictures(empty.path()).pictures.empty());
}

TEST(Pictures, NameTheFileThatIsWrong) {
  for (
      const auto& [text, said] :
      {std::pair{"{", "parse error"},
       {R"({"format":"other"})", "the format is not"},
       {R"({"format":"vobench pictures 1","width":0,"height":1,"pictures":[]})",
        "width and height must be whole numbers of 1 or more, not 0 and 1"},
       {R"({"format":"vobench pictures 1","width":1,"height":4e97,"pictures":[]})", "not 1 and 4e+97"},
       {R"({"format":"vobench pictures 1","width":4294967297,"height":1,"pictures":[]})", "not 4294967297 and 1"},
       {R"({"format":"vobench pictures 1","width":1,"height":1,"pictures":[{"timestamp":"x","features":[]}]})",
        "is no time"},
       {R"({"format":"vobench pictures 1","width":1,"height":1,"pictures":[{"timestamp":"1","features":[{"status":"odd","at":[0,0,0,0,0,0,0]}]}]})",
        "'odd' is no status"}}) {
    const TemporaryFolder folder;
    folder.Write("pictures.json", text);
    try {
      ReadPictures(folder.path());
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("pictures.json: "));
      EXPECT_THAT(error.what(), HasSubstr(said));
    }
  }
}

TEST(Ranks, ReadBackTheSame) {
  const TemporaryFolder folder;
  const std::vector<RankTable> tables = {{"rb2pf", 30, "position x", 0.25, {3, 4, 5}, {1, 1, 1}, {8, 8, 8}},
                                         {"rb2pf", 60, "position x", 0.5, {2, 10}, {2, 2}, {10, 10}}};
  WriteRanks(folder.path(), tables);
  const std::vector<RankTable> back = ReadRanks(folder.path());
  ASSERT_EQ(back.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(std::tie(back[i].system, back[i].frame, back[i].dimension, back[i].p_value, back[i].counts, back[i].low,
                       back[i].high),
              std::tie(tables[i].system, tables[i].frame, tables[i].dimension, tables[i].p_value, tables[i].counts,
                       tables[i].low, tables[i].high));
  }
  folder.Write("ranks.csv",
               "system,frame,dimension,bar,count,low,high,p_value\na,1,x,2,1,0,2,1\na,1,x,one,1,0,2,1\na,1\n");
  try {
    ReadRanks(folder.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("ranks.csv:2:1: bars of a histogram must follow"));
    EXPECT_THAT(error.what(), HasSubstr("'one' is not a finite number"));
    EXPECT_THAT(error.what(), HasSubstr("ranks.csv:4:1: 2 columns"));
  }
}

TEST(Verdict, IsReadAndShown) {
  const TemporaryFolder folder;
  const std::string header = "system,check,value,relation,threshold,pass,false_alarm\n";
  folder.Write("verdict.csv", header +
                                  "rb2pf,\"ANEES share, position\",0.95,>=,0.9,pass,0.01\n"
                                  "rbpf,\"RMSE / bound\",3.5,<=,1.2,fail,0\n");
  const std::vector<VerdictRow> rows = ReadVerdict(folder.path());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].check.name, "ANEES share, position");
  EXPECT_TRUE(rows[0].check.at_least);
  EXPECT_EQ(rows[1].check.threshold, 1.2);
  EXPECT_FALSE(rows[1].check.pass);
  const std::string html = VerdictTable(rows);
  EXPECT_THAT(html,
              HasSubstr("<td>ANEES share, position</td><td>0.950</td><td>&gt;= 0.900</td><td>pass</td><td>1 %</td>"));
  EXPECT_THAT(html, HasSubstr("<td>&lt;= 1.20</td><td><b>FAIL</b></td><td>–</td>"));
  folder.Write("verdict.csv", header + "rb2pf,\"a\",x,>=,0.9,pass,0.01\nrb2pf,a,1,>=,0.9,maybe,0.01\n");
  try {
    ReadVerdict(folder.path());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("verdict.csv:2:11: 'x' is not a finite number"));
    EXPECT_THAT(error.what(), HasSubstr("verdict.csv:3:1: not system"));
  }
  const std::string good = "a,\"b\",1,>=,2,pass,0.01";
  for (const std::string& bad : {std::string(), good + ",", good + ",3", "x," + good, "\"" + good, std::string("a,\"b"),
                                 std::string("a,\"b\",1"), std::string("a,\"b\"c,1,>=,2,pass,0.01"),
                                 std::string("a,\"b\",1,>,2,pass,0.01"), std::string("a,\"b\",,>=,2,pass,0.01")}) {
    folder.Write("verdict.csv", header + bad + "\n");
    EXPECT_THROW(ReadVerdict(folder.path()), InputError) << bad;
  }
}

TEST(Verdict, ALineMayBeLong) {
  const TemporaryFolder folder;
  const std::string header = "system,check,value,relation,threshold,pass,false_alarm\n", name(1'000'000, 'x');
  folder.Write("verdict.csv", header + "rb2pf,\"" + name + "\",1,>=,0.9,pass,0.01\n");
  EXPECT_EQ(ReadVerdict(folder.path()).at(0).check.name, name);
  folder.Write("verdict.csv", header + name + "\n");
  EXPECT_THROW(ReadVerdict(folder.path()), InputError);
}

}  // namespace
}  // namespace vobench::report
