#include <gnomon/io/atomic_file.h>
#include <gtest/gtest.h>
#include <io/write_limits.h>
#include <io/write_test_files.h>

#include <utility>

namespace gnomon {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::FileSizeLimit;
using testing::TestFolder;
using testing::WithoutRoot;

bool says(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

TEST(AtomicFile, AppearsOnlyAtCommit) {
  const TestFolder folder;
  Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
  ASSERT_TRUE(file);
  std::ofstream(file.value().temporary()) << "whole";
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  const Result<FileWritten> written = file.value().commit();
  ASSERT_TRUE(written);
  EXPECT_EQ(written.value().path, folder / "a.txt");
  EXPECT_EQ(written.value().bytes, 5U);
  EXPECT_EQ(content(folder / "a.txt"), "whole");
  EXPECT_EQ(folder.names().size(), 1U);
}

TEST(AtomicFile, IsInTheFolderOfItsTargetAndNamedAfterIt) {
  const TestFolder folder;
  const Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
  ASSERT_TRUE(file);
  EXPECT_EQ(file.value().temporary(), folder / ("a.txt.tmp-" + std::to_string(::getpid())));
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
  const TestFolder folder;
  {
    Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    const AtomicFile moved = std::move(file).value();
    EXPECT_EQ(folder.names().size(), 1U);
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, KeepsTheOlderFileUntilCommit) {
  const TestFolder folder;
  ASSERT_TRUE(write_text_file(folder / "a.txt", "old"));
  {
    const Result<AtomicFile> file = AtomicFile::create(folder / "a.txt");
    ASSERT_TRUE(file);
    std::ofstream(file.value().temporary()) << "ne";
  }
  EXPECT_EQ(content(folder / "a.txt"), "old");
  ASSERT_TRUE(write_text_file(folder / "a.txt", "new"));
  EXPECT_EQ(content(folder / "a.txt"), "new");
}

TEST(WriteTextFile, NamesThePathAndTheMissingFolder) {
  const TestFolder folder;
  const fs::path path = folder.path() / "missing" / "a.txt";
  const Result<FileWritten> written = write_text_file(path, "text");
  ASSERT_FALSE(written);
  EXPECT_TRUE(says(written.error().message, path.string())) << written.error().message;
  EXPECT_TRUE(says(written.error().message, "make the folder first")) << written.error().message;
}

TEST(WriteTextFile, DoesNotReplaceAFolder) {
  const TestFolder folder;
  fs::create_directory(folder / "a.txt");
  const Result<FileWritten> written = write_text_file(folder / "a.txt", "text");
  ASSERT_FALSE(written);
  EXPECT_TRUE(says(written.error().message, "in the way")) << written.error().message;
}

TEST(WriteTextFile, LeavesTheOlderFileWhenTheDiskIsFull) {
  const TestFolder folder;
  ASSERT_TRUE(write_text_file(folder / "a.txt", "old"));
  {
    const FileSizeLimit limit(1000);
    const Result<FileWritten> written = write_text_file(folder / "a.txt", std::string(5000, 'x'));
    ASSERT_FALSE(written);
    EXPECT_TRUE(says(written.error().message, (folder / "a.txt").string()));
  }
  EXPECT_EQ(content(folder / "a.txt"), "old");
  EXPECT_EQ(folder.names().size(), 1U);
}

TEST(MakeOutputFolder, MakesAllThatIsMissing) {
  const TestFolder folder;
  const fs::path deep = folder.path() / "a" / "b" / "c";
  ASSERT_TRUE(make_output_folder(deep));
  EXPECT_TRUE(fs::is_directory(deep));
  EXPECT_TRUE(fs::is_empty(deep));
  EXPECT_TRUE(make_output_folder(deep)) << "it is there already";
  EXPECT_TRUE(make_output_folder(folder.path() / "with slash" / ""));
}

TEST(MakeOutputFolder, RefusesAFileInTheWay) {
  const TestFolder folder;
  ASSERT_TRUE(write_text_file(folder / "out", "a file"));
  for (const fs::path& path : {folder / "out", folder.path() / "out" / "below"}) {
    const Result<fs::path> made = make_output_folder(path);
    ASSERT_FALSE(made) << path;
    EXPECT_TRUE(says(made.error().message, "Not a directory")) << made.error().message;
    EXPECT_TRUE(says(made.error().message, path.string())) << made.error().message;
  }
}

TEST(MakeOutputFolder, NamesAFolderThatMayNotBeWritten) {
  const TestFolder folder;
  fs::permissions(folder.path(), fs::perms(0555));
  const WithoutRoot user;
  if (!user.ordinary()) GTEST_SKIP() << "root may write anywhere and could not become another user";
  for (const fs::path& path : {folder.path(), folder / "below"}) {
    const Result<fs::path> made = make_output_folder(path);
    ASSERT_FALSE(made);
    EXPECT_TRUE(says(made.error().message, "Permission denied")) << made.error().message;
    EXPECT_TRUE(says(made.error().message, path.string())) << made.error().message;
  }
}

}  // namespace
}  // namespace gnomon
