//! Serves the files of one folder over HTTP on localhost, for viewing the page and for its tests.

use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::thread;

use anyhow::{Context, Result};

/// Listens on localhost.
pub struct Server {
    listener: TcpListener,
    folder: PathBuf,
}

impl Server {
    /// Opens the port; 0 selects any free port.
    pub fn new(folder: &Path, port: u16) -> Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))
            .with_context(|| format!("cannot serve on port {port}; choose another with --port N"))?;
        Ok(Self { listener, folder: folder.to_owned() })
    }

    /// The address of the page.
    pub fn address(&self) -> String {
        let port = self.listener.local_addr().map_or(0, |address| address.port());
        format!("http://localhost:{port}/")
    }

    /// Serves until the program ends.
    pub fn serve(self) -> Result<()> {
        for stream in self.listener.incoming() {
            let folder = self.folder.clone();
            // A browser may close the connection at any time; that is not an error.
            let work = move || stream.and_then(|stream| answer(&folder, stream));
            thread::Builder::new().name("answer".to_owned()).spawn(work)?;
        }
        Ok(())
    }
}

fn answer(folder: &Path, mut stream: TcpStream) -> std::io::Result<()> {
    let mut lines = BufReader::new(stream.try_clone()?).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    while lines.next().transpose()?.is_some_and(|line| !line.is_empty()) {}
    let wanted = request.split_whitespace().nth(1).unwrap_or("/");
    let wanted = wanted.split(['?', '#']).next().unwrap_or_default().trim_start_matches('/');
    let file = Path::new(if wanted.is_empty() { "index.html" } else { wanted });
    let inside = file.components().all(|part| matches!(part, Component::Normal(_)));
    let content = if inside { fs::read(folder.join(file)).ok() } else { None };
    let (status, kind, body) = match content {
        Some(body) => ("200 OK", kind(file), body),
        None => ("404 Not Found", "text/plain", b"not found".to_vec()),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         Connection: close\r\n\r\n",
        body.len()
    )?;
    stream.write_all(&body)
}

fn kind(file: &Path) -> &'static str {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript",
        Some("wasm") => "application/wasm",
        Some("webp") => "image/webp",
        _ => "application/octet-stream",
    }
}
