//! Access control: serves only a page of this server that was opened with the token of this run.
//!
//! A page of another site can send requests to 127.0.0.1. With a host name that resolves to 127.0.0.1 (DNS
//! rebinding), it can even read the responses. So a request must name a loopback host, which nobody else can own, or
//! the host of the public URL. A loopback host may have any port, since a port may be forwarded. The origin must
//! match that host or the public URL. Everything that shows data of the user also needs the token, which no other
//! page can read or send.

use crate::StudioError;
use axum::extract::Request;
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, ORIGIN, REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Uri};
use std::fmt::Write as _;
use std::net::Ipv4Addr;

/// Checks requests against the token of this run and the host names of the server.
pub(super) struct Guard {
    port: u16,
    token: String,
    public: Option<PublicUrl>,
}

/// The request header that carries the token.
const TOKEN_HEADER: &str = "x-dapple-token";

/// Content security policy: a page may load, run and connect to this server only. `'self'` is the origin that the
/// browser sees, including its sockets, whatever port is forwarded.
const POLICY: &str = "default-src 'self'; img-src 'self' blob: data:; worker-src 'self' blob:; \
    connect-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

impl Guard {
    /// Creates a guard with a new random token of 128 bits.
    pub(super) fn new(port: u16, public_url: Option<&str>) -> Result<Self, StudioError> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes).map_err(|error| {
            StudioError::new(format!("the system gives no random numbers: {error}"))
        })?;
        let token = bytes.iter().fold(String::new(), |mut token, byte| {
            write!(token, "{byte:02x}").unwrap_or_default();
            token
        });
        Ok(Self {
            port,
            token,
            public: public_url.map(PublicUrl::new).transpose()?,
        })
    }

    /// Returns the address to open. The token is in the fragment, which browsers do not send.
    pub(super) fn url(&self) -> String {
        let token = &self.token;
        match &self.public {
            Some(public) => format!("{}#t={token}", public.url),
            None => format!("http://127.0.0.1:{}/#t={token}", self.port),
        }
    }

    /// Rejects requests from other origins. The message says what the user can do.
    pub(super) fn check(&self, request: &Request) -> Result<(), String> {
        let headers = request.headers();
        let path = request.uri().path();
        // Check the host, which stops DNS rebinding.
        let Some(host) = one(headers, HOST).filter(|host| self.is_ours(host)) else {
            return Err(self.wrong_host());
        };
        // Check the origin, which is required for sockets.
        match one(headers, ORIGIN) {
            Some(origin) if !self.is_origin_of(origin, host) => {
                return Err(
                    "The request comes from another page: its Origin is not its Host. Where a proxy changes one of \
                     them, give its address to `dapple studio --public-url URL`.\n"
                        .to_owned(),
                );
            }
            None if path == "/ws" || headers.contains_key(ORIGIN) => {
                return Err(
                    "The request does not say where it comes from: it has no Origin.\n".to_owned(),
                );
            }
            _ => {}
        }
        // Check the fetch metadata of the browser.
        if !is_from_here(headers, path) {
            return Err("The request comes from another site.\n".to_owned());
        }
        // Require the token for all data of the user.
        let is_open = !["/ws", "/export/", "/image/"]
            .iter()
            .any(|start| path.starts_with(start));
        if is_open || self.has_token(request) {
            return Ok(());
        }
        Err(
            "The secret of this run is missing or wrong: open the address that the command printed, with all that \
             follows #.\n"
                .to_owned(),
        )
    }

    /// Adds security headers that keep other sites from using a response.
    pub(super) fn protect(headers: &mut HeaderMap) {
        headers.insert(CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY));
        headers.insert(X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
        headers.insert(REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
        headers.insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
        let same_origin = HeaderValue::from_static("same-origin");
        for name in ["cross-origin-resource-policy", "cross-origin-opener-policy"] {
            headers.insert(HeaderName::from_static(name), same_origin.clone());
        }
    }

    fn is_ours(&self, host: &str) -> bool {
        let is_public = |public: &PublicUrl| public.authority == public.shortened(host);
        is_loopback(host) || self.public.as_ref().is_some_and(is_public)
    }

    /// Returns whether an origin equals the host or the public URL. A proxy of the public URL may send another host.
    fn is_origin_of(&self, origin: &str, host: &str) -> bool {
        let authority = ["http://", "https://"]
            .iter()
            .find_map(|scheme| origin.strip_prefix(scheme));
        let is_public = |public: &PublicUrl| {
            origin.eq_ignore_ascii_case(&format!("{}://{}", public.scheme, public.authority))
        };
        authority.is_some_and(|authority| authority.eq_ignore_ascii_case(host))
            || self.public.as_ref().is_some_and(is_public)
    }

    fn wrong_host(&self) -> String {
        let port = self.port;
        format!(
            "dapple studio does not answer to this name. Open http://127.0.0.1:{port}/ or http://localhost:{port}/, with \
             what follows # in the address that the command printed; a forwarded port may be another.\nWhere a proxy has a \
             name of its own, start the studio with it: dapple studio --public-url https://NAME/\n"
        )
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

/// The address of the page in browsers, for use behind a proxy.
struct PublicUrl {
    /// The address of the page, with a trailing slash.
    url: String,
    scheme: &'static str,
    /// The host in lowercase, with its port unless it is the scheme's default port.
    authority: String,
}

impl PublicUrl {
    fn new(url: &str) -> Result<Self, StudioError> {
        let wrong = || {
            StudioError::new(format!("{url:?} is no address of a page"))
                .with_hint("give it as in the browser: https://name.example/ or http://name.example:8080/path/")
        };
        let uri: Uri = url.parse().map_err(|_| wrong())?;
        let scheme = match uri.scheme_str() {
            Some("http") => "http",
            Some("https") => "https",
            _ => return Err(wrong()),
        };
        let authority = uri.authority().ok_or_else(wrong)?.as_str();
        if authority.contains('@') || uri.query().is_some() || url.contains('#') {
            return Err(wrong());
        }
        let authority = shortened(scheme, authority);
        let path = uri.path().trim_end_matches('/');
        Ok(Self {
            url: format!("{scheme}://{authority}{path}/"),
            scheme,
            authority,
        })
    }

    /// Normalizes a host as browsers do under the scheme of this address.
    fn shortened(&self, host: &str) -> String {
        shortened(self.scheme, host)
    }
}

/// Converts a host to lowercase and removes the default port of the scheme.
fn shortened(scheme: &str, host: &str) -> String {
    let default = if scheme == "https" { ":443" } else { ":80" };
    let host = host.to_ascii_lowercase();
    host.strip_suffix(default).unwrap_or(&host).to_owned()
}

/// Returns whether a host is a loopback name, which no DNS server can redirect, with or without a port.
fn is_loopback(host: &str) -> bool {
    let is_port = |port: &str| !port.is_empty() && port.bytes().all(|digit| digit.is_ascii_digit());
    let name = match host.rsplit_once(':') {
        Some((name, port)) if is_port(port) => name,
        _ => host,
    };
    let is_address = |name: &str| {
        name.parse::<Ipv4Addr>()
            .is_ok_and(|address| address.is_loopback())
    };
    name.eq_ignore_ascii_case("localhost") || name == "[::1]" || is_address(name)
}

/// Returns whether the browser's fetch metadata says that a request comes from our page or from the user. The user may
/// type an address or follow a link to the page itself, which shows nothing without the token.
fn is_from_here(headers: &HeaderMap, path: &str) -> bool {
    let of = |name: &str| headers.get(name).map(HeaderValue::as_bytes);
    let opens_page = path == "/"
        && of("sec-fetch-mode") == Some(b"navigate")
        && of("sec-fetch-dest") == Some(b"document");
    opens_page || matches!(of("sec-fetch-site"), None | Some(b"same-origin" | b"none"))
}

/// Returns the value of a header that occurs exactly once; otherwise `None`.
fn one(headers: &HeaderMap, name: HeaderName) -> Option<&str> {
    let mut all = headers.get_all(name).iter();
    let value = all.next()?;
    if all.next().is_some() {
        return None;
    }
    value.to_str().ok()
}

/// Compares two tokens of equal length in constant time.
fn is_same(given: &str, wanted: &str) -> bool {
    let pairs = given.bytes().zip(wanted.bytes());
    let difference = pairs.fold(0, |difference, (a, b)| difference | (a ^ b));
    given.len() == wanted.len() && difference == 0
}
