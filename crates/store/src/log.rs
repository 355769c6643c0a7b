//! An append-only file of records, each with its length and checksum. Whatever stops the writer, the records before the
//! one in work can be read; a torn tail is cut off when the log is opened again. A damaged record with whole ones after it
//! is no torn tail: such a log is refused, lest those be lost without a word.

use crate::StoreError;
use std::fs::{File, OpenOptions};
use std::io::{BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use twox_hash::XxHash64;

/// First bytes of a log; the last one counts the changes of its layout.
const MARK: [u8; 8] = *b"flklog\0\x01";
/// Kind, length, checksum.
const HEAD: usize = 4 + 8 + 8;
/// How far after a damaged record a whole one is looked for, and how long it may be.
const SEARCHED: u64 = 1 << 20;

/// A record's place in a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Record {
    /// What it holds; the meaning is the writer's.
    pub kind: u32,
    /// Where its bytes begin.
    pub from: u64,
    /// How many there are.
    pub length: u64,
}

/// An open log.
#[derive(Debug)]
pub struct Log {
    path: PathBuf,
    file: File,
    end: u64,
}

impl Log {
    /// A new log with no records, in place of what was there.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn create(path: &Path) -> Result<Self, StoreError> {
        let open = OpenOptions::new().read(true).write(true).create(true).truncate(true).open(path);
        let mut file = open.map_err(|error| StoreError::io("create", path, error))?;
        file.write_all(&MARK).map_err(|error| StoreError::io("write", path, error))?;
        Ok(Self { path: path.to_owned(), file, end: MARK.len() as u64 })
    }
    /// Opens a log and lists its whole records; what follows them is a torn tail.
    ///
    /// # Errors
    /// Where the system refuses, the file is no log, or a record is damaged that whole ones follow.
    pub fn open(path: &Path) -> Result<(Self, Vec<Record>), StoreError> {
        Self::listed(path, OpenOptions::new().read(true).write(true))
    }
    /// Opens a log to go on with it: its torn tail is cut off, and one that is not there is begun.
    ///
    /// # Errors
    /// Where the system refuses, or the file is no log.
    pub fn resume(path: &Path) -> Result<(Self, Vec<Record>), StoreError> {
        if !path.exists() {
            return Ok((Self::create(path)?, Vec::new()));
        }
        let (mut log, records) = Self::open(path)?;
        log.keep_until(records.last())?;
        Ok((log, records))
    }
    /// As [`Self::open`], for a log that nothing will be written to.
    ///
    /// # Errors
    /// Where the system refuses, or the file is no log.
    pub fn open_to_read(path: &Path) -> Result<(Self, Vec<Record>), StoreError> {
        Self::listed(path, OpenOptions::new().read(true))
    }
    fn listed(path: &Path, how: &OpenOptions) -> Result<(Self, Vec<Record>), StoreError> {
        let open = how.open(path);
        let file = open.map_err(|error| StoreError::io("open", path, error))?;
        let mut reader = BufReader::with_capacity(1 << 16, &file);
        let mut mark = Vec::new();
        let read = Read::by_ref(&mut reader).take(MARK.len() as u64).read_to_end(&mut mark);
        read.map_err(|error| StoreError::io("read", path, error))?;
        if mark.len() < MARK.len() && MARK.starts_with(&mark) {
            // it was stopped before its first record
            return Ok((Self { path: path.to_owned(), file, end: 0 }, Vec::new()));
        }
        if mark != MARK {
            return Err(StoreError::Damaged(format!("`{}` is no log of this program", path.display())));
        }
        let size = file.metadata().map_err(|error| StoreError::io("read", path, error))?.len();
        let (mut records, mut end) = (Vec::new(), MARK.len() as u64);
        let mut payload = Vec::new();
        let mut head = [0; HEAD];
        while reader.read_exact(&mut head).is_ok() {
            let (kind, length, sum) = split(&head);
            if length > size.saturating_sub(end + HEAD as u64) {
                break;
            }
            payload.resize(length as usize, 0);
            if reader.read_exact(&mut payload).is_err() || checksum(kind, &payload) != sum {
                break;
            }
            records.push(Record { kind, from: end + HEAD as u64, length });
            end += HEAD as u64 + length;
        }
        drop(reader);
        let followed = whole_after(&mut &file, end, size).map_err(|error| StoreError::io("read", path, error))?;
        if followed {
            return Err(StoreError::Damaged(format!(
                "`{}` is damaged at byte {end}, after {} whole records and before others: take it from a copy, or cut it off \
                 there (truncate --size {end}) to have what follows computed again",
                path.display(),
                records.len(),
            )));
        }
        Ok((Self { path: path.to_owned(), file, end }, records))
    }
    /// Cuts off everything after a record (everything, for none).
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn keep_until(&mut self, record: Option<&Record>) -> Result<(), StoreError> {
        let keep = record.map_or(MARK.len() as u64, |record| record.from + record.length);
        if self.end == 0 {
            // it was stopped while its mark was written
            let rewound = self.file.seek(SeekFrom::Start(0)).and_then(|_| self.file.write_all(&MARK));
            rewound.map_err(|error| StoreError::io("write", &self.path, error))?;
        }
        self.end = keep;
        self.file.set_len(self.end).map_err(|error| StoreError::io("shorten", &self.path, error))
    }
    /// Appends a record.
    ///
    /// # Errors
    /// Where the system refuses: a full disk, for one. The log then ends before the record.
    pub fn append(&mut self, kind: u32, payload: &[u8]) -> Result<Record, StoreError> {
        let mut head = [0; HEAD];
        head[..4].copy_from_slice(&kind.to_le_bytes());
        head[4..12].copy_from_slice(&(payload.len() as u64).to_le_bytes());
        head[12..].copy_from_slice(&checksum(kind, payload).to_le_bytes());
        let write = |file: &mut File| {
            file.seek(SeekFrom::Start(self.end))?;
            file.write_all(&head)?;
            file.write_all(payload)
        };
        write(&mut self.file).map_err(|error| StoreError::io("write", &self.path, error))?;
        let record = Record { kind, from: self.end + HEAD as u64, length: payload.len() as u64 };
        self.end = record.from + record.length;
        Ok(record)
    }
    /// The bytes of a record.
    ///
    /// # Errors
    /// Where the system refuses, or the record has changed.
    pub fn read(&mut self, record: &Record) -> Result<Vec<u8>, StoreError> {
        let mut head = [0; HEAD];
        let mut payload = Vec::with_capacity(record.length as usize);
        let mut read = |file: &mut File, payload: &mut Vec<u8>| {
            file.seek(SeekFrom::Start(record.from - HEAD as u64))?;
            file.read_exact(&mut head)?;
            file.take(record.length).read_to_end(payload)
        };
        read(&mut self.file, &mut payload).map_err(|error| StoreError::io("read", &self.path, error))?;
        if split(&head) != (record.kind, payload.len() as u64, checksum(record.kind, &payload)) {
            return Err(StoreError::Damaged(format!("`{}` has changed while it was read", self.path.display())));
        }
        Ok(payload)
    }
}

/// Whether a whole record begins somewhere after a place where none does.
fn whole_after(file: &mut (impl Read + Seek), from: u64, size: u64) -> std::io::Result<bool> {
    // the damaged record and one after it
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(from))?;
    file.take(2 * SEARCHED).read_to_end(&mut bytes)?;
    // checksums cost their length: of what looks like heads in a long tail, not all can be tried
    let mut budget = 64 * SEARCHED;
    for at in 1..bytes.len().min(SEARCHED as usize) {
        let Some(head) = bytes[at..].first_chunk::<HEAD>() else { break };
        let (kind, length, sum) = split(head);
        let Some(payload) = usize::try_from(length).ok().and_then(|length| bytes.get(at + HEAD..)?.get(..length))
        else {
            continue;
        };
        if kind > u32::from(u16::MAX) || length > budget {
            continue;
        }
        budget -= length;
        if checksum(kind, payload) == sum {
            return Ok(true);
        }
    }
    // a long record whose bytes are damaged, not its head
    let Some(head) = bytes.first_chunk::<HEAD>() else { return Ok(false) };
    let next = (HEAD as u64).checked_add(split(head).1).and_then(|length| from.checked_add(length));
    let Some(next) = next.filter(|next| next + HEAD as u64 <= size) else { return Ok(false) };
    let mut head = [0; HEAD];
    file.seek(SeekFrom::Start(next))?;
    file.read_exact(&mut head)?;
    let (kind, length, sum) = split(&head);
    if length > size - next - HEAD as u64 {
        return Ok(false);
    }
    let mut payload = Vec::new();
    file.take(length).read_to_end(&mut payload)?;
    Ok(checksum(kind, &payload) == sum)
}

fn split(head: &[u8; HEAD]) -> (u32, u64, u64) {
    let word = |from: usize| u64::from_le_bytes(core::array::from_fn(|k| head[from + k]));
    (u32::from_le_bytes(core::array::from_fn(|k| head[k])), word(4), word(12))
}

fn checksum(kind: u32, payload: &[u8]) -> u64 {
    XxHash64::oneshot(u64::from(kind), payload)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn place(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("flockworks-log-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        folder.join(name)
    }

    #[test]
    fn a_log_cut_at_any_byte_gives_back_its_whole_records() {
        let path = place("cut");
        let mut log = Log::create(&path).unwrap();
        let mut ends = vec![MARK.len() as u64];
        for k in 0..4u32 {
            let record = log.append(k, &vec![k as u8; 10 * k as usize]).unwrap();
            ends.push(record.from + record.length);
        }
        let whole = std::fs::read(&path).unwrap();
        for cut in MARK.len()..=whole.len() {
            std::fs::write(&path, &whole[..cut]).unwrap();
            let (mut log, records) = Log::open(&path).unwrap();
            let expected = ends.iter().filter(|&&end| end <= cut as u64).count() - 1;
            assert_eq!(records.len(), expected, "cut at {cut}");
            for (k, record) in records.iter().enumerate() {
                assert_eq!(log.read(record).unwrap(), vec![k as u8; 10 * k]);
            }
            // what is appended after a torn tail can be read
            log.keep_until(records.last()).unwrap();
            log.append(9, b"new").unwrap();
            let (mut log, records) = Log::open(&path).unwrap();
            assert_eq!(log.read(&records[expected]).unwrap(), b"new");
        }
    }

    #[test]
    fn a_log_stopped_before_its_first_record_is_an_empty_one() {
        let path = place("begun");
        for length in 0..MARK.len() {
            std::fs::write(&path, &MARK[..length]).unwrap();
            assert!(Log::open_to_read(&path).unwrap().1.is_empty());
            assert_eq!(std::fs::read(&path).unwrap(), MARK[..length], "who only reads changes nothing");
            let (mut log, records) = Log::resume(&path).unwrap();
            assert!(records.is_empty());
            log.append(1, b"x").unwrap();
            assert_eq!(Log::open(&path).unwrap().1.len(), 1);
        }
        std::fs::write(&path, b"other").unwrap();
        assert!(Log::open(&path).is_err());
    }

    #[test]
    fn a_flipped_bit_is_noticed() {
        let path = place("bit");
        let mut log = Log::create(&path).unwrap();
        log.append(1, b"first").unwrap();
        log.append(2, b"second").unwrap();
        let whole = std::fs::read(&path).unwrap();
        for byte in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[byte] ^= 4;
            std::fs::write(&path, damaged).unwrap();
            match Log::open(&path) {
                // the last one cannot be told from one that was being written
                Ok((_, records)) => assert!(records.len() == 1 && byte >= MARK.len() + HEAD + 5, "byte {byte}"),
                Err(StoreError::Damaged(what)) if byte >= MARK.len() => assert!(what.contains("byte 8"), "{what}"),
                Err(_) => assert!(byte < MARK.len()),
            }
        }
    }

    #[test]
    fn whole_records_after_a_damaged_one_are_not_dropped() {
        let path = place("inside");
        for length in [10, 3 * SEARCHED as usize] {
            let mut log = Log::create(&path).unwrap();
            log.append(1, b"first").unwrap();
            let long = log.append(2, &vec![7; length]).unwrap();
            log.append(3, b"third").unwrap();
            let mut bytes = std::fs::read(&path).unwrap();
            bytes[long.from as usize + length / 2] ^= 1;
            std::fs::write(&path, &bytes).unwrap();
            for opened in [Log::open(&path), Log::open_to_read(&path), Log::resume(&path)] {
                let what = opened.unwrap_err().to_string();
                assert!(what.contains("after 1 whole records") && what.contains("truncate --size"), "{what}");
            }
            assert_eq!(std::fs::read(&path).unwrap(), bytes, "nothing is cut off");
            // a tail of zeros is what a machine leaves that stopped while a file grew
            bytes.truncate(long.from as usize + 4);
            bytes.extend([0; 5000]);
            std::fs::write(&path, &bytes).unwrap();
            assert_eq!(Log::open(&path).unwrap().1.len(), 1);
        }
    }
}
