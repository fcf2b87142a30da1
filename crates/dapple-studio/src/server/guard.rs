//! Who may ask: only a page of this server, opened with the secret of this run.
//!
//! A page of another site can send requests to 127.0.0.1, and by a name of its own that leads there even read the answers.
//! So the name of the host must be ours, a request that says where it comes from must come from our page, and what shows
//! anything of the user needs the secret, which is in no request that another page could see or make.

use crate::StudioError;
use axum::extract::Request;
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, ORIGIN, REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, HeaderName, HeaderValue};
use std::fmt::Write as _;

/// The secret of a run, and the names that the server has.
pub(super) struct Guard {
    port: u16,
    token: String,
}

/// The header in which the secret may be.
const TOKEN_HEADER: &str = "x-dapple-token";

impl Guard {
    /// A guard with a new secret of 128 bits.
    pub(super) fn new(port: u16) -> Result<Self, StudioError> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(|error| {
            StudioError::new(format!("the system gives no random numbers: {error}"))
        })?;
        let token = bytes.iter().fold(String::new(), |mut token, byte| {
            write!(token, "{byte:02x}").unwrap_or_default();
            token
        });
        Ok(Self { port, token })
    }

    /// The address to open. The secret is in its fragment, which browsers do not send.
    pub(super) fn url(&self) -> String {
        format!("http://127.0.0.1:{}/#t={}", self.port, self.token)
    }

    /// Refuses a request from elsewhere.
    pub(super) fn check(&self, request: &Request) -> Result<(), &'static str> {
        let headers = request.headers();
        let path = request.uri().path();
        if !one(headers, HOST).is_some_and(|host| self.is_ours(host)) {
            return Err("the host is not this server");
        }
        match one(headers, ORIGIN) {
            Some(origin)
                if !origin
                    .strip_prefix("http://")
                    .is_some_and(|host| self.is_ours(host)) =>
            {
                return Err("the request comes from another page");
            }
            None if path == "/ws" || headers.contains_key(ORIGIN) => {
                return Err("the request does not say where it comes from");
            }
            _ => {}
        }
        let site = headers.get("sec-fetch-site").map(HeaderValue::as_bytes);
        if !matches!(site, None | Some(b"same-origin" | b"none")) {
            return Err("the request comes from another site");
        }
        let is_open = !["/ws", "/export/", "/image/"]
            .iter()
            .any(|start| path.starts_with(start));
        if is_open || self.has_token(request) {
            return Ok(());
        }
        Err("the secret of this run is missing or wrong; open the address that the command printed")
    }

    /// Adds the headers that keep others from using a response.
    pub(super) fn protect(&self, headers: &mut HeaderMap) {
        let port = self.port;
        let policy = format!(
            "default-src 'self'; img-src 'self' blob: data:; worker-src 'self' blob:; \
             connect-src 'self' ws://127.0.0.1:{port} ws://localhost:{port}; object-src 'none'; base-uri 'none'; \
             form-action 'none'; frame-ancestors 'none'"
        );
        if let Ok(policy) = HeaderValue::from_str(&policy) {
            headers.insert(CONTENT_SECURITY_POLICY, policy);
        }
        headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
        headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
        headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
        let same_origin = HeaderValue::from_static("same-origin");
        for name in ["cross-origin-resource-policy", "cross-origin-opener-policy"] {
            headers.insert(HeaderName::from_static(name), same_origin.clone());
        }
    }

    fn is_ours(&self, host: &str) -> bool {
        let port = self.port;
        host == format!("127.0.0.1:{port}") || host == format!("localhost:{port}")
    }

    fn has_token(&self, request: &Request) -> bool {
        let header = request
            .headers()
            .get(TOKEN_HEADER)
            .and_then(|value| value.to_str().ok());
        let query = request.uri().query().unwrap_or_default();
        let query = query.split('&').find_map(|pair| pair.strip_prefix("t="));
        header
            .or(query)
            .is_some_and(|given| is_same(given, &self.token))
    }
}

/// The only value of a header.
fn one(headers: &HeaderMap, name: HeaderName) -> Option<&str> {
    let mut all = headers.get_all(name).iter();
    let value = all.next()?;
    if all.next().is_some() {
        return None;
    }
    value.to_str().ok()
}

/// Compares in a time that does not say how much is equal.
fn is_same(given: &str, wanted: &str) -> bool {
    let pairs = given.bytes().zip(wanted.bytes());
    let difference = pairs.fold(0, |difference, (a, b)| difference | (a ^ b));
    given.len() == wanted.len() && difference == 0
}
