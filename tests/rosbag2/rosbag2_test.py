# SPDX-License-Identifier: BSD-3-Clause
"""usage: rosbag2_test.py AIMS SCENARIO. Run by tests/rosbag2/run.sh."""

import os
import signal
import sqlite3
import subprocess
import time

import yaml

from mcap_file import McapFile
from program_test import GIVEN, ProgramTest, aims, main, poses_of, simulate
from rosbag2_folder import write_db3, write_forms, write_metadata, zstd


def sqlite(file, statement):
    return subprocess.run(["sqlite3", file, statement], capture_output=True, text=True,
                          check=True).stdout


class Recorded(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name in ("walk.bag", "walk.mcap", "walk/"):
            simulate(GIVEN[1], cls.path(name), "--set", "lidar.columns=600")
        cls.db3 = cls.path("walk/walk_0.db3")
        cls.mcap = McapFile(cls.path("walk.mcap"))

    def rows(self):
        """[(topic, time, data)] in order of time, as Python's SQLite reads them."""
        with sqlite3.connect(self.db3) as database:
            return database.execute("SELECT name, timestamp, data FROM messages JOIN topics ON "
                                    "topic_id = topics.id ORDER BY timestamp, messages.id").fetchall()

    def topics(self):
        return [(channel.topic, self.mcap.schemas[channel.schema].name,
                 channel.metadata["offered_qos_profiles"], self.mcap.schemas[channel.schema].text)
                for channel in self.mcap.channels.values()]

    def messages(self):
        places = {number: place for place, number in enumerate(self.mcap.channels)}
        return [(places[each.channel], each.log_time, each.data) for each in self.mcap.messages]


class Written(Recorded):
    def test_the_messages_are_those_of_the_mcap_file(self):
        expected = [(self.mcap.channels[each.channel].topic, each.log_time, each.data)
                    for each in self.mcap.messages]
        self.assertEqual(self.rows(), expected)

    def test_tables_are_those_of_rosbag2(self):
        self.assertEqual(sqlite(self.db3, "PRAGMA integrity_check; PRAGMA journal_mode"),
                         "ok\ndelete\n")
        self.assertEqual(sqlite(self.db3, "SELECT schema_version FROM schema"), "4\n")
        for table, columns in {
                "topics": "id,name,type,serialization_format,offered_qos_profiles,"
                          "type_description_hash",
                "messages": "id,topic_id,timestamp,data",
                "message_definitions": "id,topic_type,encoding,encoded_message_definition,"
                                       "type_description_hash",
                "metadata": "id,metadata_version,metadata"}.items():
            found = sqlite(self.db3, f"SELECT group_concat(name) FROM pragma_table_info('{table}')")
            self.assertEqual(found, columns + "\n")
        self.assertEqual(sqlite(self.db3, "SELECT sql FROM sqlite_master WHERE type = 'index'"),
                         "CREATE INDEX timestamp_idx ON messages (timestamp ASC)\n")

    def test_types_and_definitions_are_those_of_the_mcap_file(self):
        with sqlite3.connect(self.db3) as database:
            found = database.execute(
                "SELECT name, type, offered_qos_profiles, encoded_message_definition FROM topics "
                "JOIN message_definitions ON topic_type = type ORDER BY topics.id").fetchall()
        self.assertEqual(found, self.topics())

    def test_metadata_describes_the_file(self):
        with open(self.path("walk/metadata.yaml"), encoding="utf-8") as stream:
            about = yaml.safe_load(stream)["rosbag2_bagfile_information"]
        rows = self.rows()
        self.assertEqual(sorted(os.listdir(self.path("walk"))), ["metadata.yaml", "walk_0.db3"])
        self.assertEqual(about["relative_file_paths"], ["walk_0.db3"])
        self.assertEqual((about["version"], about["storage_identifier"]), (5, "sqlite3"))
        for each in (about, about["files"][0]):
            self.assertEqual(each["message_count"], len(rows))
            self.assertEqual(each["starting_time"]["nanoseconds_since_epoch"], rows[0][1])
            self.assertEqual(each["duration"]["nanoseconds"], rows[-1][1] - rows[0][1])
        counts = {each["topic_metadata"]["name"]: each["message_count"]
                  for each in about["topics_with_message_count"]}
        names = [name for name, _, _ in rows]
        self.assertEqual(counts, {name: names.count(name) for name in names})
        quality = {each["topic_metadata"]["name"]: each["topic_metadata"]["offered_qos_profiles"]
                   for each in about["topics_with_message_count"]}
        self.assertEqual(quality, {topic[0]: topic[2] for topic in self.topics()})

    def test_a_killed_recording_keeps_what_was_complete(self):
        partial = self.path("killed.partial/killed_0.db3")
        with subprocess.Popen([GIVEN[0], "simulate", GIVEN[1], "--out", self.path("killed/"), "--quiet",
                               "--set", "route.stand_before=60"]) as run:
            while not os.path.exists(partial) or os.path.getsize(partial) < 20_000_000:
                self.assertIsNone(run.poll())
                time.sleep(0.02)
            run.send_signal(signal.SIGKILL)
        folder = self.path("killed.partial")
        refused = aims("info", folder)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("has no metadata.yaml", refused.stderr)
        done = aims("convert", folder, "--recover", "--out", self.path("killed.mcap"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(os.path.getsize(self.path("killed.mcap")), 15_000_000)
        McapFile(self.path("killed.mcap"))


class Read(Recorded):
    def test_every_form_gives_the_same_trajectories(self):
        poses = poses_of(self.path("walk.bag"), self.folder.name)
        forms = [("folder", self.path("walk")), ("file", self.db3)]
        forms += write_forms(self.folder.name, self.topics(), self.messages(), self.path("walk.mcap"))
        for form, recording in forms:
            with self.subTest(form=form):
                self.assertEqual(poses_of(recording, self.folder.name), poses)
                info = aims("info", recording)
                self.assertIn(f"{len(self.mcap.messages)} messages", info.stdout)

    def test_scores_take_a_topic_of_a_folder(self):
        out = self.path("scores")
        truth = self.path("walk") + ":/ground_truth/lidar"
        run = aims("score", "--truth", truth, "--estimate", truth, "--out", out, "--quiet")
        self.assertEqual(run.returncode, 0, run.stderr + run.stdout)

    def test_converting_back_to_mcap_keeps_every_byte(self):
        self.assertEqual(aims("convert", self.path("walk"), "--out", self.path("back.mcap"))
                         .returncode, 0)
        with open(self.path("back.mcap"), "rb") as back, open(self.path("walk.mcap"), "rb") as first:
            self.assertEqual(back.read(), first.read())


class Refused(Recorded):
    def test_truncated_files_are_refused_with_and_without_recovery(self):
        with open(self.db3, "rb") as stream:
            whole = stream.read()
        for fraction in (0.1, 0.5, 0.99):
            cut = self.put("cut.db3", whole[:int(fraction * len(whole)) // 4096 * 4096])
            for options in ([], ["--recover"]):
                self.refuse("cut.db3: SQLite: database disk image is malformed; a database has no "
                            "checksums", "info", cut, *options)
        self.refuse("is damaged: expected whole pages of 4096 bytes", "info",
                    self.put("cut.db3", whole[:-1000]))

    def test_recovery_of_a_folder_reads_its_intact_files(self):
        folder = self.path("half")
        os.makedirs(folder, exist_ok=True)
        files = [os.path.join(folder, f"half_{i}.db3") for i in (2, 10)]
        middle = len(self.messages()) // 2
        write_db3(files[0], self.topics(), self.messages()[:middle])
        write_db3(files[1], self.topics(), self.messages()[middle:])
        with open(files[1], "r+b") as stream:
            stream.truncate(os.path.getsize(files[1]) // 2 // 4096 * 4096)
        write_metadata(folder, files)
        self.refuse("half_10.db3: SQLite: ", "info", folder)
        recovered = aims("info", folder, "--recover")
        self.assertIn(f" {middle} messages", recovered.stdout)
        self.assertEqual(recovered.returncode, 0, recovered.stderr)

    def test_other_compressions_and_missing_files_are_named(self):
        folder = self.path("odd")
        os.makedirs(folder, exist_ok=True)
        file = os.path.join(folder, "odd_0.db3")
        write_metadata(folder, [file])
        self.refuse("expected the file 'odd_0.db3', which metadata.yaml lists", "info", folder)
        write_db3(file, self.topics(), self.messages()[:20])
        write_metadata(folder, [file], "FILE", "lz4")
        self.refuse("metadata.yaml: compression_format: expected zstd, found 'lz4'", "info", folder)
        write_metadata(folder, [], "")
        self.refuse("relative_file_paths: expected files, found none", "info", folder)
        self.refuse("expected none for a folder of rosbag2", "convert", file, "--out",
                    self.path("packed/"), "--compression", "zstd")
        self.refuse("expected a name that ends in .bag, .mcap, or /", "convert", file, "--out",
                    self.path("x.db3"))

    def test_damaged_compression_is_named(self):
        folder = self.path("torn")
        os.makedirs(folder, exist_ok=True)
        with open(self.db3, "rb") as stream:
            packed = zstd(stream.read())
        for data, expected in ((packed[:-100], "zstd: the frame ends early"),
                               (packed + b"more", "zstd: bytes behind the frame")):
            write_metadata(folder, [self.put("torn/torn_0.db3.zstd", data)], "FILE", "zstd")
            self.refuse(expected, "info", folder, environment={"TMPDIR": folder})
            self.assertEqual(sorted(os.listdir(folder)), ["metadata.yaml", "torn_0.db3.zstd"])

    def test_folders_with_other_files_are_not_replaced(self):
        folder = self.path("mine")
        os.makedirs(folder, exist_ok=True)
        self.put("mine/notes.txt", b"precious")
        self.refuse("expected a recording to overwrite", "convert", self.path("walk.bag"), "--out",
                    folder + "/", "--overwrite")
        self.assertEqual(os.listdir(folder), ["notes.txt"])


if __name__ == "__main__":
    main(given=2)
